// The sound computed ahead: its place among the samples of the server, and the parts whose sound is not heard yet.
export class Ahead {
  constructor() {
    this.begin(0);
  }

  // Begin at a sample, with nothing ahead.
  begin(sample) {
    this.heard = this.end = this.shown = sample;
    this.parts = [];
  }

  // Number of samples ahead.
  get left() {
    return Math.max(0, this.end - this.heard);
  }

  // Add a part from sample `at` to sample `end`, in place of those that follow `at`. Without sound it is never too late,
  // even if the server returned to before what was heard.
  take(part, sounds = true) {
    if (!sounds) {
      this.heard = Math.min(this.heard, part.at);
      this.shown = Math.min(this.shown, part.at);
    }
    this.parts = this.parts.filter((one) => one.end <= part.at);
    if (part.end > this.shown) this.parts.push(part);
    this.end = part.end;
  }

  // The server computes the sound anew from a sample on.
  cut(sample) {
    this.end = Math.min(this.end, sample);
  }

  // Return the parts that are heard up to a sample, or begin to be.
  due(sample) {
    this.heard = Math.max(this.heard, sample);
    const later = this.parts.findIndex((one) => one.at >= this.heard);
    const found = this.parts.splice(0, later < 0 ? this.parts.length : later);
    if (found.length) this.shown = found.at(-1).end;
    return found;
  }
}

const REPORTS = 16;

// The sample that is heard at any time, from reports that arrive late by different times.
export class Ear {
  constructor(rate) {
    this.perMillisecond = rate / 1000;
    this.begin();
  }

  begin() {
    this.starts = [];
  }

  // A sample is heard at a time, or was heard somewhat earlier [ms].
  hears(sample, now) {
    this.starts = [...this.starts.slice(1 - REPORTS), sample - this.perMillisecond * now];
  }

  // The latest sample that may be heard at a time [ms], -Infinity without reports.
  at(now) {
    return Math.max(...this.starts) + this.perMillisecond * now;
  }
}

const SHORTEST = 0.005; // [s]
const LONGEST = 0.25;
const MOST = 0.004; // Largest increase at once [s], since a change that arrives late is heard at once all the same.
const LESS = 0.1; // Share of the time to spare by which the next lead is shorter.

// Time from the sound that is heard to the first sound of a change: so short that few changes arrive late.
export class Lead {
  constructor() {
    this.length = 0.03;
  }

  // A change arrived a time before the sound that it replaces, or after it if negative.
  arrived(spare) {
    const more = spare < 0 ? Math.min(MOST, -spare) : -LESS * spare;
    this.length = Math.min(LONGEST, Math.max(SHORTEST, this.length + more));
  }
}

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

const SHORTEST = 0.01; // [s]
const LONGEST = 0.25;
const SPARE = 0.01; // Time to spare when a change arrives [s].
const LESS = 0.2; // Share by which a longer time to spare is reduced at each change.

// Time from the sound that is heard to the first sound of a change: as short as the way of the change allows.
export class Lead {
  constructor() {
    this.length = 0.03;
  }

  // A change arrived a time before the sound that it replaces, or after it if negative.
  arrived(spare) {
    const missing = SPARE - spare;
    this.length = Math.min(LONGEST, Math.max(SHORTEST, this.length + (missing > 0 ? missing : LESS * missing)));
  }
}

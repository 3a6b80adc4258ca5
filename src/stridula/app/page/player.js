// The player: a queue of samples, a high-pass, a volume and a limiter, in the audio thread if available.
const CEILING = 0.7; // Never louder than 3 dB below full scale.
const AHEAD = 0.003; // Look-ahead of the limiter [s].
const RELEASE = 0.15; // Release time of the limiter [s].
const LOWEST = 20; // Cutoff of the high-pass [Hz].
const FADE = 0.005; // Fade time around missing samples [s].
const SPAN = 0.25; // The level is that of the largest sample in several spans of this time [s].
const SPANS = 16;
const RISE = 1; // Rise time of the gain, which falls faster [s].
const FALL = 0.02;
export const MOST = 30; // Largest gain [dB].
const FAINT = 1e-6; // Fainter sound is silence, during which the gain stays constant.

// An automatic level that follows the sound slowly, with peaks just below the limiter.
class Level {
  constructor(sampleRate) {
    this.on = true;
    this.gain = 1;
    this.largest = new Float32Array(SPANS);
    this.span = Math.round(SPAN * sampleRate);
    this.at = this.samples = this.most = 0;
    this.rise = 1 - Math.exp(-1 / (RISE * sampleRate));
    this.fall = 1 - Math.exp(-1 / (FALL * sampleRate));
  }

  // Add a sample and return its gain.
  heard(value) {
    const size = Math.abs(value);
    if (size > this.largest[this.at]) {
      this.largest[this.at] = size;
      this.most = Math.max(this.most, size);
    }
    if (++this.samples === this.span) {
      this.samples = 0;
      this.at = (this.at + 1) % SPANS;
      this.largest[this.at] = 0;
      this.most = Math.max(...this.largest);
    }
    const wanted = !this.on ? 1 : this.most > FAINT ? Math.min(10 ** (MOST / 20), CEILING / this.most) : this.gain;
    this.gain += (wanted < this.gain ? this.fall : this.rise) * (wanted - this.gain);
    return this.gain;
  }
}

export class Voice {
  constructor(sampleRate, tell) {
    Object.assign(this, { sampleRate, tell });
    this.queue = new Float32Array(1 << 17);
    this.mask = this.queue.length - 1;
    this.written = this.read = 0;
    this.end = null; // End of the sound in the queue, in samples of the server; null before the first.
    this.fresh = null; // End of the sound that is not to be replaced.
    this.jump = 0; // Difference that sound which comes late leaves, and
    this.settles = Math.exp(-1 / (FADE * sampleRate)); // its decrease per sample.
    this.marks = [];
    this.volume = this.wanted = 0;
    this.runs = false;
    this.fade = 0;
    this.dropouts = 0;
    this.needed = 0;
    this.low = this.before = 0;
    this.keep = Math.exp((-2 * Math.PI * LOWEST) / sampleRate);
    const ahead = Math.round(AHEAD * sampleRate);
    this.line = new Float32Array(ahead);
    this.at = 0;
    this.hold = ahead;
    this.peak = 0;
    this.held = 0;
    this.gain = 1;
    this.attack = 1 - Math.exp(-8 / ahead);
    this.release = 1 - Math.exp(-1 / (RELEASE * sampleRate));
    this.auto = new Level(sampleRate);
    this.quanta = 0;
    this.loudest = this.power = this.least = 0;
  }

  told(data) {
    if (data.stream) {
      this.stream = data.stream;
      this.stream.onmessage = ({ data: part }) => this.take(part);
    }
    if ("volume" in data) this.wanted = data.volume;
    if ("levelled" in data) this.auto.on = data.levelled;
    if ("needed" in data) this.needed = data.needed;
    if (data.flush) {
      this.read = this.written;
      this.runs = false;
    }
  }

  // Add sound from sample `at` of the server on, in place of the sound that is there. Sound that is to be replaced stays
  // until other sound comes, so that there is no gap if that is late.
  take({ sound, revision, at, begins }) {
    if (begins || this.end === null || at > this.end) this.end = this.fresh = at;
    const spare = at - this.heard;
    if (at < this.end && revision !== this.newest) this.spare = spare;
    const late = Math.min(sound.length, Math.max(0, -spare));
    const first = this.written - (this.end - at) + late;
    this.marks = this.marks.filter((mark) => mark.at < first);
    this.marks.push({ revision, at: first });
    this.isLate ||= late > 0;
    if (this.isLate && late < sound.length) {
      this.join(sound[late], this.next);
      this.isLate = false;
    }
    for (let i = late; i < sound.length; i++) this.queue[(first + i - late) & this.mask] = sound[i];
    this.newest = revision;
    this.fresh = Math.max(this.heard, at + sound.length);
    this.written += Math.max(0, this.fresh - this.end);
    this.end = Math.max(this.end, this.fresh);
    if (this.written - this.read > this.queue.length) this.read = this.written;
  }

  // The next sample to be heard, in samples of the server.
  get heard() {
    return this.end - (this.written - this.read);
  }

  // The value heard next if nothing comes.
  get next() {
    const goesOn = this.read < this.written && this.heard !== this.fresh;
    return goesOn ? this.queue[this.read & this.mask] + this.jump : this.last;
  }

  // Continue with a value, without a step from the last one or from another.
  join(value, from = this.last) {
    this.jump = (from ?? value) - value;
  }

  // Fill a block with the next samples.
  fill(out) {
    const step = 1 / (FADE * this.sampleRate);
    if (!this.runs && this.written - this.read >= this.needed && this.written > this.read) this.runs = true;
    for (let i = 0; i < out.length; i++) {
      let value = 0;
      if (this.runs && this.read < this.written) {
        if (this.heard === this.fresh) this.join(this.queue[this.read & this.mask]);
        value = this.queue[this.read++ & this.mask] + this.jump;
        this.jump *= this.settles;
        this.fade = Math.min(1, this.fade + step);
        this.last = value;
      } else {
        if (this.runs) {
          this.runs = false;
          this.dropouts++;
        }
        value = this.last ?? 0;
        this.fade = Math.max(0, this.fade - step);
      }
      // A high-pass removes the mean force.
      this.low = this.keep * (this.low + value - this.before);
      this.before = value;
      this.volume += 0.002 * (this.wanted - this.volume);
      const heard = this.low * this.fade;
      out[i] = this.limited(heard * this.auto.heard(heard) * this.volume);
      const size = Math.abs(out[i]);
      this.loudest = Math.max(this.loudest, size);
      this.power += size * size;
    }
    this.report(out.length);
  }

  limited(value) {
    const size = Math.abs(value);
    if (size >= this.peak || --this.held < 0) {
      this.peak = size >= this.peak ? size : Math.max(size, this.peak * 0.999);
      this.held = size >= this.peak ? this.hold : 0;
    }
    const target = this.peak > CEILING ? CEILING / this.peak : 1;
    this.gain += (target < this.gain ? this.attack : this.release) * (target - this.gain);
    this.least = Math.min(this.least, this.gain - 1);
    const late = this.line[this.at];
    this.line[this.at] = value;
    this.at = (this.at + 1) % this.line.length;
    return Math.max(-CEILING, Math.min(CEILING, late * this.gain));
  }

  report(samples) {
    while (this.marks.length && this.marks[0].at <= this.read) {
      const { revision } = this.marks.shift();
      if (revision !== this.revision) {
        this.revision = revision;
        this.tell({ revision });
      }
    }
    if (++this.quanta % 4) return;
    if (this.stream && this.end !== null) {
      this.stream.postMessage({ heard: this.heard, spare: this.spare });
      this.spare = undefined;
    } else if (this.stream) this.stream.postMessage({});
    if (this.quanta % 16) return;
    this.tell({
      peak: this.loudest,
      level: Math.sqrt(this.power / (16 * samples)),
      reduction: 1 + this.least,
      gain: this.auto.gain,
      dropouts: this.dropouts,
    });
    this.loudest = this.power = this.least = 0;
  }
}

if (globalThis.AudioWorkletProcessor) {
  class Player extends AudioWorkletProcessor {
    constructor() {
      super();
      this.voice = new Voice(sampleRate, (said) => this.port.postMessage(said));
      this.port.onmessage = ({ data }) => this.voice.told(data);
    }

    process(_, [[out]]) {
      this.voice.fill(out);
      return true;
    }
  }
  registerProcessor("player", Player);
}

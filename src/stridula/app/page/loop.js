// The last sound in a loop at true speed, for systems computed slower than real time.
import { highPassed, joined } from "./samples.js";

const RATE = 48000;
const LONGEST = 4; // [s]
const SHORTEST = 0.02; // Shortest sound [s].
const LED_OVER = 0.25; // Largest fraction of the sound that is cross-faded from its end to its beginning,
const BLEND = 0.05; // and largest duration of the cross-fade [s].
const LOUDEST = 0.7; // 3 dB below full scale.

export class Loop {
  constructor(onChange) {
    Object.assign(this, { onChange, parts: [], samples: 0, source: null });
  }

  // Discard the sound after a change of scenario or source.
  forget() {
    this.parts = [];
    this.samples = 0;
    this.stop();
  }

  take(sound) {
    this.parts.push(sound.slice());
    this.samples += sound.length;
    while (this.samples - this.parts[0].length >= LONGEST * RATE) this.samples -= this.parts.shift().length;
  }

  get isLongEnough() {
    return this.samples >= SHORTEST * RATE;
  }

  play(decibels) {
    const sound = looped(this.parts);
    this.context ??= new AudioContext({ sampleRate: RATE });
    this.context.resume();
    const buffer = this.context.createBuffer(1, sound.length, RATE);
    buffer.copyToChannel(sound, 0);
    this.source = Object.assign(this.context.createBufferSource(), { buffer, loop: true });
    this.gain = this.context.createGain();
    this.source.connect(this.gain).connect(this.context.destination);
    this.volume(decibels);
    this.source.start();
    this.seconds = sound.length / RATE;
    this.onChange();
  }

  // The volume lowers the sound from the loudest allowed level.
  volume(decibels) {
    if (this.gain) this.gain.gain.value = 10 ** (Math.min(0, decibels) / 20);
  }

  stop() {
    if (!this.source) return;
    this.source.stop();
    this.source = this.gain = null;
    this.onChange();
  }
}

// The sound in one piece, without its mean, at full level, with its end cross-faded to its beginning.
export function looped(parts) {
  const whole = highPassed(joined(parts), RATE);
  const over = Math.min(Math.round(BLEND * RATE), Math.floor(LED_OVER * whole.length));
  const sound = whole.slice(0, whole.length - over);
  const end = whole.subarray(whole.length - over);
  for (let i = 0; i < over; i++) {
    const share = (i + 0.5) / over;
    sound[i] = Math.sqrt(share) * sound[i] + Math.sqrt(1 - share) * end[i];
  }
  const most = sound.reduce((largest, value) => Math.max(largest, Math.abs(value)), 0);
  return most > 0 ? sound.map((value) => (LOUDEST * value) / most) : sound;
}

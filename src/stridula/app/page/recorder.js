// Recording of the sound as a WAV file.
import { highPassed, joined } from "./samples.js";

const LONGEST = 60; // [s]
const CLOSE = 0.15; // Uncertainty of times [s], for parts come one by one.
const HEADROOM = 10 ** (-1 / 20); // The largest sample is 1 dB below full scale.
const LARGEST = 0x7fff;

export class Recorder {
  constructor(rate) {
    this.rate = rate;
    this.blocks = null;
    this.since = null;
  }

  get on() {
    return this.blocks !== null;
  }

  // Recorded time [s].
  get seconds() {
    return this.kept / this.rate;
  }

  // Begin at a time [s], while sound is heard or not.
  begin(now, hears) {
    Object.assign(this, { blocks: [], kept: 0, sources: new Map(), heardFor: 0, since: null });
    this.hears(hears, now);
  }

  // Sound is to be heard from a time on [s], or not.
  hears(hears, now) {
    if (this.since !== null) this.heardFor += now - this.since;
    this.since = hears ? now : null;
  }

  // Time in which sound was to be heard and did not come [s], as far as it matters.
  get missing() {
    const missing = Math.min(this.heardFor, LONGEST) - this.seconds;
    return missing > CLOSE ? missing : 0;
  }

  // Keep a part, to be multiplied by its scale, in the unit of its source; return whether there is room for more.
  take(sound, { scale, unit }) {
    const part = sound.slice(0, LONGEST * this.rate - this.kept);
    this.sources.set(`${scale} ${unit}`, { scale, unit });
    this.blocks.push(part.map((value) => value * scale));
    this.kept += part.length;
    return this.kept < LONGEST * this.rate;
  }

  // End at a time [s]; return the bytes of a WAV file, null if nothing was recorded.
  end(now) {
    this.hears(false, now);
    const { blocks, sources } = this;
    this.blocks = null;
    if (!this.kept) return null;
    const sound = highPassed(joined(blocks), this.rate);
    const largest = sound.reduce((most, value) => Math.max(most, Math.abs(value)), 0) / HEADROOM || 1;
    const [{ scale, unit }] = sources.values();
    // Several sources have no common full scale.
    const full = sources.size === 1 ? `full scale is ${Number((largest / scale).toPrecision(6))} ${unit}` : "several sources";
    return wav(sound, largest, this.rate, `stridula: recorded on the page, ${full}`);
  }
}

function wav(sound, largest, rate, comment) {
  const words = new TextEncoder().encode(comment.padEnd(comment.length + 2 - (comment.length % 2), "\0"));
  const [data, list] = [2 * sound.length, 12 + words.length];
  const view = new DataView(new ArrayBuffer(44 + 8 + list + data));
  let at = 0;
  const text = (word) => [...word].forEach((one) => view.setUint8(at++, one.charCodeAt(0)));
  const number = (value, bytes) => {
    if (bytes === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += bytes;
  };
  text("RIFF");
  number(view.byteLength - 8, 4);
  text("WAVEfmt ");
  for (const [value, bytes] of [[16, 4], [1, 2], [1, 2], [rate, 4], [2 * rate, 4], [2, 2], [16, 2]]) number(value, bytes);
  text("LIST");
  number(list, 4);
  text("INFOICMT");
  number(words.length, 4);
  words.forEach((one) => view.setUint8(at++, one));
  text("data");
  number(data, 4);
  for (const value of sound) {
    view.setInt16(at, Math.round((LARGEST * value) / largest), true);
    at += 2;
  }
  return view.buffer;
}

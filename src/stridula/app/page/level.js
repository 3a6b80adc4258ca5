// The level of the sound in words.
import { MOST } from "./player.js";

const CLOSE = 0.5; // Distance from the largest gain at which it is reached [dB].

// What 0 dB of volume means, with the automatic level or without, for a source and the present gain.
export function levelWords({ full_scale: fullScale, unit }, levelled, gain = 1) {
  if (!levelled) return `At 0 dB, ${fullScale} ${unit} is full scale.`;
  if (20 * Math.log10(gain) > MOST - CLOSE) return `Automatic level: the sound is so faint that it is amplified by ${MOST} dB, the most possible.`;
  return `Automatic level: the loudest sound of the last 4 s comes to 3 dB below full scale.`;
}

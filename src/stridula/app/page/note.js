// The note of a frequency, and the growing mode of linear theory it may belong to.
const NAMES = ["C", "C♯", "D", "D♯", "E", "F", "F♯", "G", "G♯", "A", "A♯", "B"];
const A4 = 440; // [Hz]
const A4_KEY = 69; // Its MIDI number.
const NEAR = 0.05; // Largest distance of a tone from its mode, relative to the mode.

// The nearest note of equal temperament with its octave, and the deviation of the frequency from it.
export function noteOf(frequency) {
  const key = A4_KEY + 12 * Math.log2(frequency / A4);
  const nearest = Math.round(key);
  return { name: `${NAMES[((nearest % 12) + 12) % 12]}${Math.floor(nearest / 12) - 1}`, cents: Math.round(100 * (key - nearest)) };
}

// The mode of nearest frequency, null if none is near.
export function modeOf(frequency, modes) {
  const away = (mode) => Math.abs(frequency / mode.frequency - 1);
  const nearest = modes.reduce((best, mode) => (best === null || away(mode) < away(best) ? mode : best), null);
  return nearest !== null && away(nearest) <= NEAR ? nearest : null;
}

// Note and mode as texts, empty without a tone.
export function reading(frequency, modes) {
  if (!(frequency > 0)) return { note: "", mode: "" };
  const { name, cents } = noteOf(frequency);
  const off = cents === 0 ? "" : ` ${cents > 0 ? "+" : "−"}${Math.abs(cents)} cents`;
  const mode = modeOf(frequency, modes);
  return { note: `${name}${off}`, mode: mode ? `near the growing mode at ${pitch(mode.frequency)}` : "" };
}

function pitch(frequency) {
  return frequency >= 1000 ? `${(frequency / 1000).toFixed(2)} kHz` : `${Math.round(frequency)} Hz`;
}

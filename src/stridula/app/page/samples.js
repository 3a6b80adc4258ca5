// Sound as numbers: pieces in one, and without what cannot be heard.
const LOWEST = 20; // What is slower cannot be heard [Hz].

// Pieces one after the other.
export function joined(parts) {
  const found = new Float32Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    found.set(part, at);
    at += part.length;
  }
  return found;
}

// A high-pass as the player has it.
export function highPassed(sound, rate) {
  const keep = Math.exp((-2 * Math.PI * LOWEST) / rate);
  let [low, before] = [0, sound[0]];
  return sound.map((value) => {
    low = keep * (low + value - before);
    before = value;
    return low;
  });
}

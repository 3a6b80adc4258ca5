// Sound as numbers: joined pieces, and a high-pass.
const LOWEST = 20; // Cutoff of the high-pass [Hz].

// Pieces joined in sequence.
export function joined(parts) {
  const found = new Float32Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    found.set(part, at);
    at += part.length;
  }
  return found;
}

// The high-pass of the player.
export function highPassed(sound, rate) {
  const keep = Math.exp((-2 * Math.PI * LOWEST) / rate);
  let [low, before] = [0, sound[0]];
  return sound.map((value) => {
    low = keep * (low + value - before);
    before = value;
    return low;
  });
}

// Spectra and the strongest tone of a sound, independent of the page.
export const LOWEST = 20; // Lowest tone [Hz].
const FAINT = 1e-5; // Level relative to the largest value below which a signal is rounding noise.

export function hann(size) {
  return Float32Array.from({ length: size }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / size));
}

// Frequency of the strongest tone of a signal [Hz], null if there is none: the strongest peak of the spectrum. A
// value at its edge, or on the slope of a slower peak, does not count.
export function strongestTone(signal, rate) {
  const size = signal.length;
  const power = spectrum(signal, hann(size));
  let best = null;
  for (let i = Math.ceil((LOWEST * size) / rate); i < power.length - 1; i++) {
    if (power[i] > power[i - 1] && power[i] >= power[i + 1] && (best === null || power[i] > power[best])) best = i;
  }
  let largest = 0;
  for (const value of signal) largest = Math.max(largest, Math.abs(value));
  if (best === null || !((4 * Math.sqrt(power[best])) / size > FAINT * largest)) return null;
  // The top of a parabola through three points on a logarithmic scale, at most half a bin from the peak.
  const [a, b, c] = [best - 1, best, best + 1].map((i) => Math.log(power[i] + 1e-30));
  const shift = (0.5 * (a - c)) / (a - 2 * b + c || 1);
  return ((best + Math.max(-0.5, Math.min(0.5, shift))) * rate) / size;
}

// Power of a real signal at the frequencies of its samples, by the fast Fourier transform.
export function spectrum(signal, window) {
  const size = signal.length;
  const [re, im] = [new Float32Array(size), new Float32Array(size)];
  let mean = 0;
  for (const value of signal) mean += value / size;
  const bits = Math.log2(size);
  for (let i = 0; i < size; i++) {
    let j = 0;
    for (let b = 0; b < bits; b++) j |= ((i >> b) & 1) << (bits - 1 - b);
    re[j] = (signal[i] - mean) * window[i];
  }
  for (let half = 1; half < size; half *= 2) {
    for (let k = 0; k < half; k++) {
      const [c, s] = [Math.cos((-Math.PI * k) / half), Math.sin((-Math.PI * k) / half)];
      for (let i = k; i < size; i += 2 * half) {
        const j = i + half;
        const [x, y] = [re[j] * c - im[j] * s, re[j] * s + im[j] * c];
        re[j] = re[i] - x;
        im[j] = im[i] - y;
        re[i] += x;
        im[i] += y;
      }
    }
  }
  return Float32Array.from({ length: size / 2 }, (_, i) => re[i] ** 2 + im[i] ** 2);
}

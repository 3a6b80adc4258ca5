// Spectra of a sound, independent of the page.

export function hann(size) {
  return Float32Array.from({ length: size }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / size));
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

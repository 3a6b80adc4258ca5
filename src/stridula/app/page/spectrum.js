// Spectra of a sound, independent of the page.

export function hann(size) {
  return Float32Array.from({ length: size }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / size));
}

// Transform a complex signal in place, by the fast Fourier transform; its length is a power of two.
export function transformed(re, im) {
  const size = re.length;
  for (let i = 1, j = 0; i < size; i++) {
    let bit = size >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j |= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
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
}

// Power of a real signal at the frequencies of its samples.
export function spectrum(signal, window) {
  const size = signal.length;
  let mean = 0;
  for (const value of signal) mean += value / size;
  const [re, im] = [signal.map((value, i) => (value - mean) * window[i]), new Float32Array(size)];
  transformed(re, im);
  return Float32Array.from({ length: size / 2 }, (_, i) => re[i] ** 2 + im[i] ** 2);
}

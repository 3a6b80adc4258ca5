// The spectrogram of the sound, with its axes and the scale of its colours.
import { inWords, Layer, paintAxes, ticks, told } from "./axes.js";
import { joined } from "./samples.js";
import { hann, spectrum } from "./spectrum.js";

const RATE = 48000;
const SIZE = 1024; // Samples of a spectrum.
const HOP = 256; // Samples between spectra.
const HIGHEST = 12000; // Highest frequency shown [Hz].
const DEEP = 60; // Level shown below the loudest [dB].
const KEPT = 2000; // Number of spectra kept.
const FORGETS = 0.995; // Factor by which the loudest level decays per spectrum.
const [LEFT, RIGHT, ABOVE, BELOW] = [42, 56, 6, 32];
const FIRST = ["The first spectrum appears", `after ${Math.round((1000 * SIZE) / RATE)} ms played.`];
const BAR = 10; // Width of the scale of colours [px].

export class Spectrogram {
  constructor() {
    this.window = hann(SIZE);
    this.axes = new Layer();
    this.clear();
  }

  // Clear the spectrogram for another source.
  clear() {
    this.columns = [];
    this.image = null;
    this.loudest = 1e-9;
    this.forget();
  }

  // Discard the samples so far after a discontinuity.
  forget() {
    this.sound = new Float32Array(0);
  }

  // Redraw all in other colours.
  repaint() {
    this.columns.forEach((column) => (column.drawn = false));
    this.image = null;
  }

  // Add the spectra of new sound.
  hear(sound) {
    const all = joined([this.sound, sound]);
    let start = 0;
    for (; start + SIZE <= all.length; start += HOP) this.columns.push({ power: spectrum(all.subarray(start, start + SIZE), this.window) });
    this.sound = all.slice(start);
    // A hidden page draws nothing.
    if (this.columns.length > 2 * KEPT) this.columns = this.columns.slice(-KEPT);
  }

  draw([draw, width, height], modes, colours, dark) {
    const box = { left: LEFT, top: ABOVE, width: Math.max(1, width - LEFT - RIGHT), height: Math.max(1, height - ABOVE - BELOW) };
    if (!this.columns.length) {
      this.axes.draw(draw, width, height, [colours.line, "empty"], (paint) => inWords(paint, box, FIRST, colours));
      return;
    }
    this.#paint(box, dark);
    this.axes.draw(draw, width, height, [colours.line, colours.soft], (paint) => axes(paint, box, width, colours, dark));
    draw.drawImage(this.image, box.left, box.top, box.width, box.height);
    draw.fillStyle = colours.sticking;
    for (const { frequency } of modes) {
      if (frequency > HIGHEST) continue;
      const y = box.top + box.height * (1 - frequency / HIGHEST);
      draw.fillRect(box.left, y, 10, 2);
      draw.fillRect(box.left + box.width - 10, y, 10, 2);
    }
  }

  // Scroll the image by the new spectra.
  #paint({ width, height }, dark) {
    if (!this.image || this.image.width !== Math.floor(width) || this.image.height !== Math.floor(height)) {
      this.image = new OffscreenCanvas(Math.floor(width), Math.floor(height));
      this.columns = this.columns.slice(-this.image.width);
      this.columns.forEach((column) => (column.drawn = false));
    }
    const paint = this.image.getContext("2d");
    const rows = this.image.height;
    const fresh = this.columns.filter((column) => !column.drawn);
    for (const column of fresh) for (const value of column.power) this.loudest = Math.max(this.loudest, value);
    this.loudest *= FORGETS ** fresh.length;
    const few = fresh.slice(-this.image.width);
    if (few.length) {
      paint.drawImage(this.image, -few.length, 0);
      const strip = paint.createImageData(few.length, rows);
      const bins = Math.round((HIGHEST / RATE) * SIZE);
      for (let i = 0; i < few.length; i++) {
        for (let row = 0; row < rows; row++) {
          const bin = Math.floor(((rows - 1 - row) / rows) * bins);
          const [r, g, b] = heat(1 + (10 * Math.log10((few[i].power[bin] + 1e-30) / this.loudest)) / DEEP, dark);
          strip.data.set([r, g, b, 255], 4 * (row * few.length + i));
        }
      }
      paint.putImageData(strip, this.image.width - few.length, 0);
    }
    fresh.forEach((column) => (column.drawn = true));
    this.columns = this.columns.slice(-KEPT);
  }
}

function axes(draw, box, width, colours, dark) {
  const span = (box.width * HOP) / RATE;
  const sides = { x: { low: -span, high: 0, title: "time before now [s]" }, y: { low: 0, high: HIGHEST / 1000, title: "frequency [kHz]" } };
  paintAxes(draw, box, sides, colours);
  const left = box.left + box.width + 12;
  for (let row = 0; row < box.height; row++) {
    draw.fillStyle = `rgb(${heat(1 - row / box.height, dark).map(Math.round).join()})`;
    draw.fillRect(left, box.top + row, BAR, 1.5);
  }
  draw.strokeStyle = colours.line;
  draw.strokeRect(left + 0.5, box.top + 0.5, BAR - 1, box.height - 1);
  draw.fillStyle = colours.soft;
  for (const level of ticks(-DEEP, 0, box.height / 30)) draw.fillText(told(level), left + BAR + 4, box.top + 4 - (box.height * level) / DEEP);
  draw.textAlign = "right";
  draw.fillText("level [dB]", width - 2, box.top + box.height + 27);
  draw.textAlign = "left";
}

// A scale from ground to ink with evenly rising lightness, readable without colours.
export function heat(share, dark) {
  const t = Math.max(0, Math.min(1, share));
  const stops = dark
    ? [[20, 23, 27], [38, 52, 110], [150, 54, 116], [240, 130, 60], [252, 240, 170]]
    : [[251, 251, 249], [197, 218, 236], [112, 158, 208], [48, 84, 150], [16, 24, 60]];
  const at = Math.min(stops.length - 2, Math.floor(t * (stops.length - 1)));
  const part = t * (stops.length - 1) - at;
  return stops[at].map((one, i) => one + part * (stops[at + 1][i] - one));
}

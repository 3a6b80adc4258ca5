// Level over frequency: of the sound of the last moments, of the other setting, and of a microphone.
import { inWords, Layer, paintAxes, told } from "./axes.js";
import { joined } from "./samples.js";
import { hann, spectrum } from "./spectrum.js";

const RATE = 48000;
const SIZE = 8192; // Samples of a spectrum.
const HELD = 2 * SIZE; // Samples kept.
const [LOWEST, HIGHEST] = [50, 12000]; // Ends of the axis [Hz].
const DEEP = 80; // Level shown below the loudest [dB].
const AGAIN = 80; // Shortest time between spectra [ms].
const MARKS = [50, 100, 200, 500, 1000, 2000, 5000, 10000]; // Frequencies with a number [Hz].
const [LEFT, RIGHT, ABOVE, BELOW] = [42, 12, 6, 32];
const FIRST = ["The first spectrum appears", `after ${Math.round((1000 * SIZE) / RATE)} ms played.`];
const DASHES = [5, 4];

export class Spectra {
  constructor() {
    this.window = hann(SIZE);
    this.axes = new Layer();
    this.clear();
  }

  clear() {
    this.sound = new Float32Array(0);
    this.power = null;
    this.time = -Infinity;
  }

  hear(sound) {
    this.sound = joined([this.sound, sound]).slice(-HELD);
  }

  // Power of the last sound over frequency, null if there is too little.
  now() {
    const count = this.sound.length;
    if (count < SIZE) return null;
    const moments = [0, 0.5, 1].map((share) => Math.round(share * (count - SIZE)));
    return mean([...new Set(moments)].map((start) => spectrum(this.sound.subarray(start, start + SIZE), this.window)));
  }

  // Draw the curves: the playing one, and others with their own rates; a level of 0 dB is the loudest of each, or of
  // the playing one where a curve has the same scale.
  draw([draw, width, height], { name, others }, modes, colours) {
    const box = { left: LEFT, top: ABOVE, width: Math.max(1, width - LEFT - RIGHT), height: Math.max(1, height - ABOVE - BELOW) };
    const now = performance.now();
    if (now - this.time > AGAIN) Object.assign(this, { power: this.now() ?? this.power, time: now });
    if (!this.power && !others.length) {
      inWords(draw, box, FIRST, colours);
      return;
    }
    this.axes.draw(draw, width, height, [colours.line, colours.soft], (paint) => axes(paint, box, colours));
    const loudest = this.power ? loudestOf(this.power, RATE) : 0;
    const curves = [...(this.power ? [{ name, power: this.power, rate: RATE, colour: colours.trace, wide: 1.4 }] : []), ...others];
    draw.fillStyle = colours.sticking;
    for (const { frequency } of modes) if (frequency > LOWEST && frequency < HIGHEST) draw.fillRect(across(frequency, box) - 1, box.top + box.height - 10, 2, 10);
    for (const one of curves) curve(draw, one, one.isSame && loudest ? loudest : loudestOf(one.power, one.rate), box);
    legend(draw, curves, box, colours);
  }
}

export function mean(powers) {
  return powers[0].map((_, k) => powers.reduce((sum, one) => sum + one[k], 0) / powers.length);
}

function loudestOf(power, rate) {
  const each = rate / (2 * power.length);
  let found = 1e-30;
  for (let k = Math.ceil(LOWEST / each); k < Math.min(power.length, HIGHEST / each); k++) found = Math.max(found, power[k]);
  return found;
}

export function across(frequency, { left, width }) {
  return left + (width * Math.log(frequency / LOWEST)) / Math.log(HIGHEST / LOWEST);
}

// The loudest in each column, joined by lines where columns are narrower than the spectrum is fine.
function curve(draw, { power, rate, colour, wide, dashed }, loudest, box) {
  const each = rate / (2 * power.length);
  const columns = new Map();
  for (let k = Math.ceil(LOWEST / each); k < Math.min(power.length, HIGHEST / each); k++) {
    const x = Math.round(across(k * each, box));
    columns.set(x, Math.max(columns.get(x) ?? 0, power[k]));
  }
  const y = (value) => box.top + (box.height * Math.min(DEEP, Math.max(0, -10 * Math.log10((value + 1e-30) / loudest)))) / DEEP;
  draw.strokeStyle = colour;
  draw.lineWidth = wide;
  draw.setLineDash(dashed ? DASHES : []);
  draw.beginPath();
  [...columns].forEach(([x, value], i) => (i ? draw.lineTo(x, y(value)) : draw.moveTo(x, y(value))));
  draw.stroke();
  draw.setLineDash([]);
}

// Names of curves beside pieces of them, from the right.
export function legend(draw, curves, { left, top, width }, colours, fewest = 2) {
  if (curves.length < fewest) return;
  let x = left + width - 6;
  draw.font = "12px system-ui, sans-serif";
  for (const { name, colour, wide, dashed } of [...curves].reverse()) {
    x -= draw.measureText(name).width;
    draw.fillStyle = colours.panel;
    draw.globalAlpha = 0.8;
    draw.fillRect(x - 24, top + 3, draw.measureText(name).width + 26, 16);
    draw.globalAlpha = 1;
    draw.fillStyle = colours.ink;
    draw.fillText(name, x, top + 15);
    draw.strokeStyle = colour;
    draw.lineWidth = Math.max(1.5, wide);
    draw.setLineDash(dashed ? DASHES : []);
    draw.beginPath();
    draw.moveTo(x - 22, top + 11);
    draw.lineTo(x - 5, top + 11);
    draw.stroke();
    draw.setLineDash([]);
    x -= 32;
  }
}

function axes(draw, box, colours) {
  const at = MARKS.map((one) => [across(one, box), one < 1000 ? String(one) : `${told(one / 1000)}k`]);
  const sides = { x: { low: 0, high: 0, title: "frequency [Hz]" }, y: { low: -DEEP, high: 0, title: "level [dB]" } };
  paintAxes(draw, box, sides, colours);
  draw.textAlign = "center";
  for (const [x, word] of at) {
    draw.fillRect(x, box.top + box.height, 1, 4);
    draw.fillText(word, x, box.top + box.height + 14);
  }
  draw.textAlign = "left";
}

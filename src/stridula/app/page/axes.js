// Axes with ticks, numbers, units and a title; the unchanging part is drawn once and then copied.
const STEPS = [1, 2, 2.5, 5, 10];
const ROOFS = [1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10];
const ROUNDING = 1e-9;
const SMALL = "11px system-ui, sans-serif";
const APART = 44; // Space for a number across [px]
const ABOVE = 26; // and upwards.

export function short(value) {
  return Number(value.toPrecision(3)).toString();
}

// The label of a tick.
export function told(value) {
  return short(value).replace("-", "−");
}

// Round values between two ends, with a limited number of steps.
export function ticks(low, high, most) {
  const rough = (high - low) / Math.max(1, most);
  if (!(rough > 0) || !Number.isFinite(rough)) return [];
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = size * STEPS.find((one) => one * size >= rough * (1 - ROUNDING));
  const found = [];
  for (let k = Math.ceil(low / step - ROUNDING); k * step <= high + ROUNDING * step; k++) found.push(Number((k * step).toPrecision(12)) + 0);
  return found;
}

// The next round value above a number: an axis that ends there is steady.
export function roof(value) {
  const size = 10 ** Math.floor(Math.log10(value));
  return size * ROOFS.find((one) => one * size >= value * (1 - ROUNDING));
}

// The next of 1, 2 and 5 below a value, and of their multiples by ten.
export function rounded(value) {
  const size = 10 ** Math.floor(Math.log10(value));
  return size * (value / size >= 5 ? 5 : value / size >= 2 ? 2 : 1);
}

// Draw axes around a box. A side has its ends and a title with its unit.
export function paintAxes(draw, { left, top, width, height }, { x, y }, colours) {
  draw.font = SMALL;
  draw.lineWidth = 1;
  draw.strokeStyle = colours.line;
  draw.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
  draw.fillStyle = colours.soft;
  draw.textAlign = "center";
  for (const value of ticks(x.low, x.high, width / APART)) {
    const at = left + (width * (value - x.low)) / (x.high - x.low);
    draw.fillRect(Math.min(at, left + width - 1), top + height, 1, 4);
    draw.fillText(told(value), at, top + height + 14);
  }
  draw.fillText(x.title, left + width / 2, top + height + 27);
  draw.textAlign = "right";
  for (const value of ticks(y.low, y.high, height / ABOVE)) {
    const at = top + height * (1 - (value - y.low) / (y.high - y.low));
    draw.fillRect(left - 4, Math.min(at, top + height - 1), 4, 1);
    draw.fillText(told(value), left - 7, at + 4);
  }
  draw.save();
  draw.translate(10, top + height / 2);
  draw.rotate(-Math.PI / 2);
  draw.textAlign = "center";
  draw.fillText(y.title, 0, 0);
  draw.restore();
  draw.textAlign = "left";
}

// Show a text in place of a picture.
export function inWords(draw, { left, top, width, height }, words, colours) {
  draw.strokeStyle = colours.line;
  draw.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
  draw.font = "13px system-ui, sans-serif";
  draw.fillStyle = colours.soft;
  draw.textAlign = "center";
  words.forEach((line, i) => draw.fillText(line, left + width / 2, top + height / 2 + 18 * (i - (words.length - 1) / 2) + 4));
  draw.textAlign = "left";
}

// A picture redrawn only if its arguments change.
export class Layer {
  draw(onto, width, height, depends, paint) {
    const scale = onto.getTransform().a;
    const known = JSON.stringify([width, height, scale, depends]);
    if (known !== this.known) {
      this.known = known;
      this.image = new OffscreenCanvas(Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale)));
      const draw = this.image.getContext("2d");
      draw.setTransform(scale, 0, 0, scale, 0, 0);
      paint(draw);
    }
    onto.drawImage(this.image, 0, 0, width, height);
  }
}

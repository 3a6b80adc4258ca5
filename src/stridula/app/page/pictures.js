// The pictures: what has come since the last one, drawn once for each frame of the screen.
import { drawLines, Frame, placed } from "./lines.js";
import { hann, spectrum, strongestTone } from "./spectrum.js";

const RATE = 48000;
const KEPT = 1 << 15; // Points of force and state that are kept.
const SIZE = 1024; // Samples of a spectrum.
const HOP = 256; // Samples between spectra.
const HEARD = 1 << 14; // Samples in which the strongest tone is looked for: bins of 3 Hz.
const HIGHEST = 12000; // Highest frequency shown [Hz].
const WINDOW = 1.0; // Time shown live [s].
const PORTRAIT = 0.06; // Time of the phase portrait live [s].
const FALL = 400; // An axis comes down over so much [ms].
export const STATES = ["separated", "sticking", "sliding"];

// The top of an axis: up at once to what is seen, and soon down to it.
export class Top {
  constructor() {
    this.value = this.time = 0;
  }

  follow(largest, now) {
    this.value = Math.max(1.05 * largest, this.value * Math.exp((this.time - now) / FALL));
    this.time = now;
    return this.value;
  }
}

// Where a word beside the tip begins: on the side to which the slider does not lean, or below where there is no room.
export function besideTip(x, y, lean, word, width) {
  const left = lean > 0 ? x - 14 - word : x + 14;
  if (left >= 4 && left + word <= width - 4) return [left, y - 14];
  return [Math.max(4, Math.min(width - 4 - word, x - word / 2)), y + 26];
}

export class Pictures {
  constructor(space) {
    this.space = space;
    this.canvases = Object.fromEntries(["beams", "timeline", "phase", "spectrogram"].map((name) => [name, document.getElementById(name)]));
    this.force = new Float32Array(KEPT);
    this.state = new Uint8Array(KEPT);
    this.time = new Float64Array(KEPT);
    this.place = new Float64Array(KEPT);
    this.speed = new Float32Array(KEPT);
    this.count = 0;
    this.sound = new Float32Array(0);
    this.columns = [];
    this.slow = 1;
    this.exaggeration = 0;
    this.loudest = 1e-9;
    this.top = new Top();
    this.window = hann(SIZE);
    this.heard = new Float32Array(0);
    this.theme();
  }

  theme() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    this.colours = Object.fromEntries(["ink", "soft", "line", "panel", "trace", "mark", ...STATES].map((name) => [name, colour(name)]));
    this.dark = document.documentElement.dataset.theme === "dark";
    this.columns.forEach((column) => (column.drawn = false));
    this.image = null;
  }

  // Take over a part.
  take({ head, values }) {
    const [, clock, stroke, samples, seen, nodes, points, contacts, place] = head;
    let at = 0;
    const next = (count) => values.subarray(at, (at += count));
    const sound = next(samples);
    const [force, , state, moved, speed] = [0, 1, 2, 3, 4].map(() => next(seen));
    const [height] = next(1);
    const interval = samples / seen / RATE;
    for (let i = 0; i < seen; i++) {
      const k = this.count++ % KEPT;
      this.force[k] = force[i];
      this.state[k] = state[i];
      this.place[k] = place + moved[i];
      this.speed[k] = speed[i];
      this.time[k] = clock - (seen - 1 - i) * interval;
    }
    if (stroke !== this.stroke) this.begun = this.count - seen;
    this.clock = clock;
    this.stroke = stroke;
    this.shapes = { place, height, slider: next(2 * nodes), track: next(points), contacts: next(2 * contacts) };
    if (this.slow === 1) this.#hear(sound);
  }

  describe(scene) {
    // Another system begins another picture.
    const known = JSON.stringify([scene.lines, scene.track, scene.drawn]);
    if (known !== this.known) this.frame = new Frame();
    if (this.scene && drawnAs(scene) !== drawnAs(this.scene)) this.shapes = null;
    else if (scene.lines && this.shapes && this.shapes.slider.length !== expected(scene)) this.shapes = null;
    this.known = known;
    this.scene = scene;
    this.canvases.beams.hidden = Boolean(scene.drawn);
    this.space.describe(scene);
  }

  pace(slow) {
    this.slow = slow;
    this.sound = this.heard = new Float32Array(0);
  }

  // Shares of the states over the time shown, and the root mean square of what was heard last.
  get shares() {
    const found = [0, 0, 0];
    const points = this.#since(WINDOW);
    for (const k of points) found[this.state[k]]++;
    return found.map((one) => one / Math.max(1, points.length));
  }

  #since(seconds, begun = 0) {
    const first = Math.max(begun, this.count - KEPT + 1, 0);
    const found = [];
    for (let n = this.count - 1; n >= first; n--) {
      const k = n % KEPT;
      if (this.time[k] < this.clock - seconds) break;
      found.push(k);
    }
    return found.reverse();
  }

  // The beams in every frame, the others in turns.
  draw() {
    if (!this.scene || !this.shapes) return;
    if (this.scene.drawn) this.much = this.space.draw(this.shapes, this.clock, this.colours);
    else if (this.scene.lines) this.#lines();
    else if (this.shapes.track.length) this.#beams();
    this.turn = !this.turn;
    if (this.turn) this.#timeline();
    else {
      this.#phase();
      this.#spectrogram();
    }
  }

  #begin(name) {
    const canvas = this.canvases[name];
    const scale = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
    }
    const draw = canvas.getContext("2d");
    draw.setTransform(scale, 0, 0, scale, 0, 0);
    draw.clearRect(0, 0, width, height);
    draw.font = "12px system-ui, sans-serif";
    draw.lineJoin = "round";
    return [draw, width, height];
  }

  #beams() {
    const [draw, width, height] = this.#begin("beams");
    const { place, height: lift, slider, track } = this.shapes;
    const { slider: body, track: beam } = this.scene;
    const margin = 24;
    const [rise, reach] = [body.length * Math.cos(body.angle), body.length * Math.sin(body.angle)];
    const [left, right] = [Math.min(0, place + reach), Math.max(beam.length, place + reach)];
    const [tall, space] = [Math.max(rise, 0.15 * beam.length), height - 2 * margin - 34];
    const scale = Math.min((width - 2 * margin) / (right - left), space / tall);
    const [x0, y0] = [(width - scale * (right - left)) / 2 - scale * left, height - margin - 26 - (space - scale * tall) / 2];
    let most = 1e-12;
    for (const value of track) most = Math.max(most, Math.abs(value));
    for (const value of slider) most = Math.max(most, Math.abs(value));
    const wanted = (0.06 * beam.length) / most;
    // Sooner smaller than larger: what is drawn never leaves the picture.
    this.exaggeration = this.exaggeration === 0 || wanted < this.exaggeration ? wanted : this.exaggeration * Math.min(1.01, wanted / this.exaggeration);
    const much = rounded(this.exaggeration);
    const at = (x, y) => [x0 + scale * x, y0 - scale * y];

    draw.strokeStyle = this.colours.line;
    draw.lineWidth = 1;
    draw.setLineDash([4, 4]);
    line(draw, [at(0, 0), at(beam.length, 0)]);
    draw.setLineDash([]);
    for (const x of [0, beam.length]) support(draw, ...at(x, 0), this.colours.soft);
    draw.strokeStyle = this.colours.ink;
    draw.lineWidth = 4;
    line(draw, [...track].map((w, i) => at((beam.length * i) / (track.length - 1), much * w)));

    const nodes = slider.length / 2;
    const points = [];
    for (let i = 0; i < nodes; i++) {
      const s = (body.length * i) / (nodes - 1);
      points.push(at(place + s * Math.sin(body.angle) + much * slider[2 * i], s * Math.cos(body.angle) + much * (lift + slider[2 * i + 1])));
    }
    draw.strokeStyle = this.colours.mark;
    line(draw, points);
    draw.fillStyle = this.colours.mark;
    const [rx, ry] = points.at(-1);
    draw.fillRect(rx - 6, ry - 6, 12, 12);

    const state = this.state[(this.count - 1) % KEPT];
    const [cx, cy] = points[0];
    draw.beginPath();
    draw.arc(cx, cy, 8, 0, 2 * Math.PI);
    draw.fillStyle = this.colours[STATES[state]];
    draw.fill();
    draw.lineWidth = 1.5;
    draw.strokeStyle = this.colours.ink;
    draw.stroke();
    draw.fillStyle = this.colours.ink;
    draw.fillText(STATES[state], ...besideTip(cx, cy, body.angle, draw.measureText(STATES[state]).width, width));
    draw.fillStyle = this.colours.soft;
    draw.fillText(`stroke ${this.stroke}, tip at ${(1000 * place).toFixed(1)} mm`, 8, height - 6);
    this.much = much;
  }

  #lines() {
    if (this.shapes.slider.length !== expected(this.scene)) return;
    const [draw, width, height] = this.#begin("beams");
    const lines = placed(this.scene, this.shapes.slider);
    const much = this.frame.follow(lines, this.scene);
    this.much = much ? rounded(much) : 0;
    const at = this.frame.to(width, height);
    drawLines(draw, this.scene, lines, this.shapes.contacts, at, this.much, this.colours, STATES, this.frame.extent);
    draw.fillStyle = this.colours.soft;
    draw.fillText(`stroke ${this.stroke}, ${short(1000 * this.frame.extent)} mm across`, 8, height - 6);
  }

  #timeline() {
    const [draw, width, height] = this.#begin("timeline");
    const span = this.slow === 1 ? WINDOW : WINDOW / this.slow;
    const points = this.#since(span);
    const [left, lanes] = [44, 3 * 11 + 6];
    const [inner, tall] = [width - left - 6, height - lanes - 18];
    let largest = 1e-9;
    for (const k of points) largest = Math.max(largest, this.force[k]);
    const top = this.top.follow(largest, performance.now());
    const start = this.clock - span;
    const x = (k) => left + ((this.time[k] - start) / span) * inner;
    const y = (value) => 6 + tall * (1 - value / top);
    axis(draw, this.colours, left, 6, inner, tall, `${short(top)} N`, "0");
    // Of the points in a column the largest and the least: nothing is lost between them.
    const columns = new Map();
    for (const k of points) {
      const column = Math.floor(x(k));
      const one = columns.get(column) ?? { low: Infinity, high: -Infinity, states: 0 };
      one.low = Math.min(one.low, this.force[k]);
      one.high = Math.max(one.high, this.force[k]);
      one.states |= 1 << this.state[k];
      columns.set(column, one);
    }
    draw.fillStyle = draw.strokeStyle = this.colours.trace;
    draw.lineWidth = 1.5;
    if (points.length < inner) line(draw, points.map((k) => [x(k), y(this.force[k])]));
    else {
      let before = null;
      for (const [column, { low, high }] of columns) {
        const [up, down] = before ? [Math.max(high, before.low), Math.min(low, before.high)] : [high, low];
        draw.fillRect(column, y(up), 1, Math.max(1.2, y(down) - y(up)));
        before = { low, high };
      }
    }
    STATES.forEach((name, state) => {
      const lane = 6 + tall + 5 + 11 * state;
      draw.fillStyle = this.colours.line;
      draw.fillRect(left, lane + 9, inner, 0.5);
      draw.fillStyle = this.colours[name];
      let from = null;
      for (const [column, { states }] of columns) {
        if (states & (1 << state)) {
          const start = from === null ? column : Math.max(left, from + 1);
          draw.fillRect(start, lane, column - start + 1, 9);
        }
        from = column;
      }
    });
    draw.fillStyle = this.colours.soft;
    draw.textAlign = "right";
    draw.fillText(`${short(1000 * span)} ms`, width - 6, height - 4);
    draw.textAlign = "left";
  }

  #phase() {
    const [draw, width, height] = this.#begin("phase");
    const points = this.#since(this.slow === 1 ? PORTRAIT : Math.max(PORTRAIT / this.slow, 4e-4), this.begun);
    if (points.length < 2) return;
    // Travel at the mean velocity is no vibration.
    const [first, last] = [points[0], points.at(-1)];
    const drift = (this.place[last] - this.place[first]) / Math.max(1e-9, this.time[last] - this.time[first]);
    const across = points.map((k) => this.place[k] - drift * (this.time[k] - this.time[first]));
    const [low, high] = [Math.min(...across), Math.max(...across)];
    let fastest = 1e-9;
    for (const k of points) fastest = Math.max(fastest, Math.abs(this.speed[k]));
    const half = Math.max((high - low) / 2, 1e-12);
    this.half = this.half && this.half > half ? Math.max(half, 0.97 * this.half) : half;
    this.fastest = this.fastest && this.fastest > fastest ? Math.max(fastest, 0.97 * this.fastest) : fastest;
    const [left, wide, tall] = [56, width - 64, height - 26];
    const x = (value) => left + (wide / 2) * (1 + (value - (low + high) / 2) / (1.1 * this.half));
    const y = (value) => 4 + (tall / 2) * (1 - value / (1.1 * this.fastest));
    axis(draw, this.colours, left, 4, wide, tall, short(1.1 * this.fastest), short(-1.1 * this.fastest));
    draw.fillStyle = this.colours.soft;
    draw.fillText("m/s", 4, 4 + tall / 2);
    draw.textAlign = "right";
    draw.fillText(`± ${short(1.1e6 * this.half)} µm`, width - 8, height - 6);
    draw.textAlign = "left";
    draw.lineWidth = 1.3;
    for (let i = 1; i < points.length; i++) {
      draw.globalAlpha = 0.15 + (0.85 * i) / points.length;
      draw.strokeStyle = this.dark || this.state[points[i]] !== 2 ? this.colours[STATES[this.state[points[i]]]] : "#8a7f00";
      line(draw, [[x(across[i - 1]), y(this.speed[points[i - 1]])], [x(across[i]), y(this.speed[points[i]])]]);
    }
    draw.globalAlpha = 1;
  }

  // Keep the spectra of what is heard.
  #hear(sound) {
    this.heard = joined(this.heard, sound).slice(-HEARD);
    const all = joined(this.sound, sound);
    let start = 0;
    for (; start + SIZE <= all.length; start += HOP) this.columns.push({ power: spectrum(all.subarray(start, start + SIZE), this.window) });
    this.sound = all.slice(start);
    let [sum, mean] = [0, 0];
    for (const value of sound) mean += value / sound.length;
    for (const value of sound) sum += (value - mean) ** 2;
    this.level = Math.sqrt(sum / Math.max(1, sound.length));
  }

  // Frequency of the strongest tone of what was heard last [Hz], null where there is none or too little was heard.
  get tone() {
    return this.heard.length === HEARD ? strongestTone(this.heard, RATE) : null;
  }

  #spectrogram() {
    const canvas = this.canvases.spectrogram;
    const scale = 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const left = 44;
    if (!this.image || this.image.width !== Math.max(1, width - left) || this.image.height !== height) {
      this.image = new OffscreenCanvas(Math.max(1, width - left), height);
      this.columns = this.columns.slice(-this.image.width);
      this.columns.forEach((column) => (column.drawn = false));
    }
    const paint = this.image.getContext("2d");
    const fresh = this.columns.filter((column) => !column.drawn);
    for (const column of fresh) for (const value of column.power) this.loudest = Math.max(this.loudest, value);
    this.loudest *= 0.9995 ** fresh.length;
    const few = fresh.slice(-this.image.width);
    if (few.length) {
      paint.drawImage(this.image, -few.length, 0);
      const strip = paint.createImageData(few.length, height);
      const bins = Math.round((HIGHEST / RATE) * SIZE);
      for (let i = 0; i < few.length; i++) {
        for (let row = 0; row < height; row++) {
          const bin = Math.floor(((height - 1 - row) / height) * bins);
          const [r, g, b] = heat(1 + Math.log10((few[i].power[bin] + 1e-30) / this.loudest) / 6, this.dark);
          strip.data.set([r, g, b, 255], 4 * (row * few.length + i));
        }
      }
      paint.putImageData(strip, this.image.width - few.length, 0);
    }
    fresh.forEach((column) => (column.drawn = true));
    this.columns = this.columns.slice(-2000);
    const [draw] = this.#begin("spectrogram");
    draw.drawImage(this.image, left, 0, (width - left) * scale, height * scale);
    draw.fillStyle = this.colours.soft;
    for (let khz = 0; khz <= HIGHEST / 1000; khz += 3) {
      const y = height * (1 - (1000 * khz) / HIGHEST);
      draw.fillText(`${khz} kHz`, 2, Math.min(height - 3, Math.max(11, y + 4)));
    }
    for (const { frequency } of this.modes ?? []) {
      if (frequency > HIGHEST) continue;
      draw.fillStyle = this.colours.sticking;
      draw.fillRect(left, height * (1 - frequency / HIGHEST), 10, 2);
      draw.fillRect(width - 10, height * (1 - frequency / HIGHEST), 10, 2);
    }
  }
}

// How bodies are drawn: in space, as lines, or as two beams.
const drawnAs = ({ drawn, lines }) => (drawn ? "space" : lines ? "lines" : "beams");

// Numbers that a part has of the lines of a system.
function expected({ lines }) {
  return lines.reduce((sum, { places }) => sum + 2 * (places.length + 1), 0);
}

function joined(one, other) {
  const found = new Float32Array(one.length + other.length);
  found.set(one);
  found.set(other, one.length);
  return found;
}

function line(draw, points) {
  draw.beginPath();
  points.forEach(([x, y], i) => (i ? draw.lineTo(x, y) : draw.moveTo(x, y)));
  draw.stroke();
}

function support(draw, x, y, colour) {
  draw.fillStyle = colour;
  draw.beginPath();
  draw.moveTo(x, y + 3);
  draw.lineTo(x - 8, y + 17);
  draw.lineTo(x + 8, y + 17);
  draw.fill();
}

function axis(draw, colours, left, top, width, height, high, low) {
  draw.strokeStyle = colours.line;
  draw.lineWidth = 1;
  draw.strokeRect(left, top, width, height);
  draw.fillStyle = colours.soft;
  draw.textAlign = "right";
  draw.fillText(high, left - 4, top + 10);
  draw.fillText(low, left - 4, top + height);
  draw.textAlign = "left";
}

function rounded(value) {
  const size = 10 ** Math.floor(Math.log10(value));
  return size * (value / size >= 5 ? 5 : value / size >= 2 ? 2 : 1);
}

export function short(value) {
  return Number(value.toPrecision(3)).toString();
}

// A scale from ground to ink that rises evenly in lightness: it reads without colours, too.
function heat(share, dark) {
  const t = Math.max(0, Math.min(1, share));
  const stops = dark
    ? [[20, 23, 27], [38, 52, 110], [150, 54, 116], [240, 130, 60], [252, 240, 170]]
    : [[251, 251, 249], [197, 218, 236], [112, 158, 208], [48, 84, 150], [16, 24, 60]];
  const at = Math.min(stops.length - 2, Math.floor(t * (stops.length - 1)));
  const part = t * (stops.length - 1) - at;
  return stops[at].map((one, i) => one + part * (stops[at + 1][i] - one));
}

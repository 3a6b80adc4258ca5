// The pictures, drawn once per frame from the parts received since the last one.
import { rounded, short } from "./axes.js";
import { History } from "./history.js";
import { drawLines, Frame, placed } from "./lines.js";
import { Phase } from "./phase.js";
import { Spectra } from "./spectra.js";
import { Spectrogram } from "./spectrogram.js";
import { path, Timeline, WINDOW } from "./timeline.js";

const RATE = 48000;
export const STATES = ["separated", "sticking", "sliding"];

// Position of a text beside the tip: on the side away from the slider, or below if there is no space.
export function besideTip(x, y, lean, word, width) {
  const left = lean > 0 ? x - 14 - word : x + 14;
  if (left >= 4 && left + word <= width - 4) return [left, y - 14];
  return [Math.max(4, Math.min(width - 4 - word, x - word / 2)), y + 26];
}

export class Pictures {
  constructor(space) {
    this.space = space;
    this.canvases = Object.fromEntries(["beams", "timeline", "phase", "spectrogram"].map((name) => [name, document.getElementById(name)]));
    this.history = new History();
    this.timeline = new Timeline();
    this.phase = new Phase();
    this.spectrogram = new Spectrogram();
    this.spectra = new Spectra();
    this.asSpectrum = false; // Whether the sound is shown as a spectrum.
    this.held = null; // Pictures of the other setting.
    this.mine = null; // Spectrum of the microphone.
    this.modes = [];
    this.slow = 1;
    this.drawnSince = 0;
    this.exaggeration = 0;
    this.theme();
  }

  theme() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    this.colours = Object.fromEntries(["ink", "soft", "line", "panel", "trace", "mark", "held", "mine", ...STATES].map((name) => [name, colour(name)]));
    this.dark = document.documentElement.dataset.theme === "dark";
    this.spectrogram.repaint();
  }

  // Add a part.
  take({ head, values }) {
    const [revision, clock, stroke, samples, seen, nodes, points, contacts, place] = head;
    let at = 0;
    const next = (count) => values.subarray(at, (at += count));
    const sound = next(samples);
    const [force, , state, moved, speed] = [0, 1, 2, 3, 4].map(() => next(seen));
    const [height] = next(1);
    this.history.take({ clock, stroke, place, interval: samples / seen / RATE }, [force, state, moved, speed]);
    const shapes = { place, height, slider: next(2 * nodes), track: next(points), contacts: next(2 * contacts) };
    // Parts of the system before are still heard, but have other shapes.
    if (revision >= this.drawnSince) this.shapes = shapes;
    this.#hear(sound);
  }

  describe(scene) {
    // A new system starts a new picture.
    const known = JSON.stringify([scene.lines, scene.track, scene.drawn]);
    if (known !== this.known) this.frame = new Frame();
    if (!this.scene || kindOf(scene) !== kindOf(this.scene)) Object.assign(this, { shapes: null, drawnSince: scene.revision });
    this.known = known;
    this.scene = scene;
    this.canvases.beams.hidden = Boolean(scene.drawn);
    this.space.describe(scene);
  }

  // Clear the pictures for a new motion.
  clear() {
    this.modes = [];
    this.spectra.clear();
    this.spectrogram.clear();
  }

  // Pictures of the setting that plays, to be held while the other one does, null if there is nothing yet.
  hold(name, source) {
    const points = this.history.since(WINDOW);
    if (!points.length) return null;
    return { name, source, power: this.spectra.now(), force: points.map((k) => [this.history.time[k] - this.history.clock, this.history.force[k]]) };
  }

  pace(slow) {
    this.slow = slow;
  }

  // Shares of the states over the time shown.
  get shares() {
    const found = [0, 0, 0];
    const points = this.history.since(WINDOW);
    for (const k of points) found[this.history.state[k]]++;
    return found.map((one) => one / Math.max(1, points.length));
  }

  // The beams in every frame, the others in turns.
  draw() {
    if (!this.scene || !this.shapes) return;
    if (this.scene.drawn) this.much = this.space.draw(this.shapes, this.history.clock, this.colours);
    else if (this.scene.lines) this.#lines();
    else if (this.shapes.track.length) this.#beams();
    this.turn = !this.turn;
    if (this.turn) this.timeline.draw(this.#begin("timeline"), this.history, this.slow, this.colours, STATES, this.held);
    else {
      this.phase.draw(this.#begin("phase"), this.history, this.slow, this.colours, STATES, this.dark);
      if (this.asSpectrum) this.spectra.draw(this.#begin("spectrogram"), this.#curves(), this.modes, this.colours);
      else this.spectrogram.draw(this.#begin("spectrogram"), this.modes, this.colours, this.dark);
    }
  }

  // The curves of the spectrum: names, and those beside the playing one.
  #curves() {
    const others = [];
    const { held, mine, colours } = this;
    // Levels of another source would say nothing.
    if (held?.power && held.source === this.source) others.push({ name: `${held.name}, held`, power: held.power, rate: RATE, colour: colours.held, wide: 1, dashed: true, isSame: true });
    if (mine) others.push({ name: "microphone", power: mine.power, rate: mine.rate, colour: colours.mine, wide: 1.4 });
    return { name: held ? `${this.playing}, playing` : "computed", others };
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
    // Rounded down, so that nothing leaves the picture.
    this.exaggeration = this.exaggeration === 0 || wanted < this.exaggeration ? wanted : this.exaggeration * Math.min(1.01, wanted / this.exaggeration);
    const much = rounded(this.exaggeration);
    const at = (x, y) => [x0 + scale * x, y0 - scale * y];

    draw.strokeStyle = this.colours.line;
    draw.lineWidth = 1;
    draw.setLineDash([4, 4]);
    path(draw, [at(0, 0), at(beam.length, 0)]);
    draw.setLineDash([]);
    for (const x of [0, beam.length]) support(draw, ...at(x, 0), this.colours.soft);
    draw.strokeStyle = this.colours.ink;
    draw.lineWidth = 4;
    path(draw, [...track].map((w, i) => at((beam.length * i) / (track.length - 1), much * w)));

    const nodes = slider.length / 2;
    const points = [];
    for (let i = 0; i < nodes; i++) {
      const s = (body.length * i) / (nodes - 1);
      points.push(at(place + s * Math.sin(body.angle) + much * slider[2 * i], s * Math.cos(body.angle) + much * (lift + slider[2 * i + 1])));
    }
    draw.strokeStyle = this.colours.mark;
    path(draw, points);
    draw.fillStyle = this.colours.mark;
    const [rx, ry] = points.at(-1);
    draw.fillRect(rx - 6, ry - 6, 12, 12);

    const state = this.history.now;
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
    draw.fillText(`stroke ${this.history.stroke}, tip at ${(1000 * place).toFixed(1)} mm`, 8, height - 6);
    this.much = much;
  }

  #lines() {
    const [draw, width, height] = this.#begin("beams");
    const lines = placed(this.scene, this.shapes.slider);
    const much = this.frame.follow(lines, this.scene);
    this.much = much ? rounded(much) : 0;
    const at = this.frame.to(width, height);
    drawLines(draw, this.scene, lines, this.shapes.contacts, at, this.much, this.colours, STATES, this.frame.extent);
    draw.fillStyle = this.colours.soft;
    draw.fillText(`stroke ${this.history.stroke}, ${short(1000 * this.frame.extent)} mm across`, 8, height - 6);
  }

  // Update the spectrogram and the level.
  #hear(sound) {
    this.spectrogram.hear(sound);
    this.spectra.hear(sound);
    let [sum, mean] = [0, 0];
    for (const value of sound) mean += value / sound.length;
    for (const value of sound) sum += (value - mean) ** 2;
    this.level = Math.sqrt(sum / Math.max(1, sound.length));
  }
}

// Shapes of one kind have the same numbers.
function kindOf({ drawn, lines }) {
  if (drawn) return drawn;
  return lines ? `${lines.map(({ places }) => places.length)} points` : "beams";
}

function support(draw, x, y, colour) {
  draw.fillStyle = colour;
  draw.beginPath();
  draw.moveTo(x, y + 3);
  draw.lineTo(x - 8, y + 17);
  draw.lineTo(x + 8, y + 17);
  draw.fill();
}

// The map of regimes around the played scenario, and its cross-hair.
import { si } from "./controls.js";
import { paintAxes } from "./axes.js";

const POINTS = 16;
const HELD = 5000; // Time without a drop-out after which a suspended map continues [ms].
const QUIET = 700; // Time without a change after which a map is computed [ms].
const PATIENCE = 5000; // Time without a row after which the wait is explained [ms].
// Signs that distinguish regimes without colours.
const SIGNS = { "stable sliding": "", sticking: "–", "stick-slip": "/", squeal: "~", judder: "×", "off the track": "·" };

export class RegimeMap {
  constructor(scene, controls, regimes, say) {
    Object.assign(this, { scene, controls, regimes, say });
    this.canvas = document.getElementById("map");
    this.x = document.getElementById("map-x");
    this.y = document.getElementById("map-y");
    this.on = document.getElementById("map-on");
    this.words = document.getElementById("map-words");
    this.cells = new Map();
    this.known = "";
    for (const side of [this.x, this.y]) side.addEventListener("change", () => this.follow(true));
    this.on.addEventListener("change", () => this.follow(true));
    let moving = false;
    const go = (event) => {
      this.#go(event.offsetX, event.offsetY, moving);
      moving = true;
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      moving = false;
      this.canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    this.canvas.addEventListener("pointermove", (event) => event.buttons && go(event));
    this.canvas.addEventListener("pointerup", () => (moving = false));
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
    const legend = document.getElementById("map-legend");
    legend.replaceChildren(
      ...Object.entries(regimes).map(([name, colour]) => {
        const item = document.createElement("li");
        const key = Object.assign(document.createElement("span"), { className: "key" });
        key.style.background = colour;
        item.append(key, `${name}${SIGNS[name] ? ` (${SIGNS[name]})` : ""}`);
        return item;
      }),
    );
  }

  // Update to a scenario: the keys to vary, and a new map unless only the cross-hair moved.
  follow(at_once = false) {
    const numbers = this.controls.numbers();
    this.#offer(this.x, numbers, "contact.friction.coefficient", 0);
    this.#offer(this.y, numbers, "slider.angle", 1);
    const [a, b] = [this.side("x"), this.side("y")];
    if (!a || !b) return;
    const others = Object.entries(this.controls.values).filter(([key]) => key !== a.key && key !== b.key);
    const wanted = JSON.stringify([a.key, b.key, a.low, a.high, b.low, b.high, others, this.on.checked]);
    if (wanted === this.known) return;
    this.known = wanted;
    this.cells.clear();
    this.words.textContent = this.slow && !this.on.checked ? "computed only on request: this system is slow" : "";
    this.say({ type: "no map" });
    clearTimeout(this.timer);
    this.pending = null;
    if (!this.on.checked) return;
    this.timer = setTimeout(() => this.#ask(a, b), at_once ? 0 : QUIET);
  }

  // Slow systems are not computed hundreds of times except on request.
  rest(slow) {
    if (slow === Boolean(this.slow)) return;
    this.slow = slow;
    this.on.checked = !slow;
  }

  // Suspend the computation of a map in favour of the sound.
  hold() {
    if (!this.pending) return;
    const [a, b] = this.pending;
    this.say({ type: "no map" });
    this.words.textContent = "suspended in favour of the sound";
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.#ask(a, b), HELD);
  }

  again() {
    this.known = "";
  }

  side(name) {
    const control = this.controls.numbers().find((one) => one.key === this[name].value);
    if (!control) return null;
    const value = this.controls.values[control.key] / control.scale;
    // The sense of motion that is played.
    const [low, high] = control.low < 0 ? (value < 0 ? [control.low, 0] : [0, control.high]) : [control.low, control.high];
    return { key: control.key, control, low: Math.min(low, value), high: Math.max(high, value) };
  }

  #offer(select, numbers, first, other) {
    const keys = numbers.map((one) => one.key);
    if (JSON.stringify(keys) === select.dataset.keys) return;
    const chosen = keys.includes(select.value) ? select.value : keys.includes(first) ? first : keys[other];
    select.replaceChildren(...numbers.map((one) => new Option(one.label, one.key)));
    select.value = chosen;
    select.dataset.keys = JSON.stringify(keys);
  }

  #ask(a, b) {
    if (a.key === b.key) {
      this.words.textContent = "choose two different quantities";
      return;
    }
    const axis = ({ key, control, low, high }) => ({ key, low: si(low, control), high: si(high, control) });
    this.words.textContent = "computing";
    this.pending = [a, b];
    this.say({ type: "map", x: axis(a), y: axis(b), points: POINTS });
    const wait = "computing the first row; the first map of all compiles code, which takes up to a minute";
    this.timer = setTimeout(() => (this.words.textContent = wait), PATIENCE);
  }

  take({ row, regimes }) {
    clearTimeout(this.timer);
    this.cells.set(row, regimes);
    this.words.textContent = `${Math.round((100 * this.cells.size) / POINTS)} % computed`;
  }

  done() {
    this.pending = null;
    this.words.textContent = "runs of up to 1 s from the start";
  }

  #frame() {
    return { left: 56, top: 6, width: this.canvas.clientWidth - 68, height: this.canvas.clientHeight - 38 };
  }

  #go(px, py, moving) {
    const { left, top, width, height } = this.#frame();
    const clamp = (value) => Math.max(0, Math.min(1, value));
    this.#set(clamp((px - left) / width), clamp(1 - (py - top) / height), moving);
  }

  #set(u, v, moving) {
    const [a, b] = [this.side("x"), this.side("y")];
    if (!a || !b || a.key === b.key) return;
    const at = ({ control, low, high }, share) => si(Number((low + share * (high - low)).toPrecision(4)), control);
    this.scene.values({ [a.key]: at(a, u), [b.key]: at(b, v) }, moving);
  }

  #key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
    const [a, b] = [this.side("x"), this.side("y")];
    if (!step || !a || !b) return;
    event.preventDefault();
    const share = ({ control, key, low, high }) => (this.controls.values[key] / control.scale - low) / (high - low);
    const clamp = (value) => Math.max(0, Math.min(1, value));
    const size = event.shiftKey ? 0.002 : 0.02;
    this.#set(clamp(share(a) + size * step[0]), clamp(share(b) + size * step[1]), event.repeat);
  }

  draw(colours) {
    const scale = Math.min(2, window.devicePixelRatio || 1);
    const { clientWidth, clientHeight } = this.canvas;
    const sides = [this.side("x"), this.side("y")];
    // Redrawn after a change.
    const shown = JSON.stringify([clientWidth, clientHeight, scale, colours.line, this.cells.size, this.known, sides, this.controls.values]);
    if (shown === this.shown) return;
    this.shown = shown;
    if (this.canvas.width !== Math.round(clientWidth * scale) || this.canvas.height !== Math.round(clientHeight * scale)) {
      this.canvas.width = Math.round(clientWidth * scale);
      this.canvas.height = Math.round(clientHeight * scale);
    }
    const draw = this.canvas.getContext("2d");
    draw.setTransform(scale, 0, 0, scale, 0, 0);
    draw.clearRect(0, 0, clientWidth, clientHeight);
    draw.font = "12px system-ui, sans-serif";
    const { left, top, width, height } = this.#frame();
    const [a, b] = sides;
    if (!a || !b) return;
    const [w, h] = [width / POINTS, height / POINTS];
    for (const [row, regimes] of this.cells) {
      regimes.forEach((name, column) => {
        const [x, y] = [left + column * w, top + height - (row + 1) * h];
        draw.fillStyle = this.regimes[name] ?? colours.panel;
        draw.fillRect(x, y, w + 0.5, h + 0.5);
        draw.fillStyle = "#1b1f24";
        draw.textAlign = "center";
        draw.globalAlpha = 0.55;
        if (w > 9 && h > 9) draw.fillText(SIGNS[name] ?? "?", x + w / 2, y + h / 2 + 4);
        draw.globalAlpha = 1;
      });
    }
    const titled = ({ control, low, high }) => ({ low, high, title: control.unit ? `${control.label} [${control.unit}]` : control.label });
    paintAxes(draw, { left, top, width, height }, { x: titled(a), y: titled(b) }, colours);
    const at = ({ control, key, low, high }) => (this.controls.values[key] / control.scale - low) / (high - low);
    const [x, y] = [left + width * at(a), top + height * (1 - at(b))];
    for (const [colour, thick] of [["#ffffff", 4], ["#000000", 1.6]]) {
      draw.strokeStyle = colour;
      draw.lineWidth = thick;
      draw.beginPath();
      draw.moveTo(x - 14, y);
      draw.lineTo(x + 14, y);
      draw.moveTo(x, y - 14);
      draw.lineTo(x, y + 14);
      draw.stroke();
      draw.beginPath();
      draw.arc(x, y, 7, 0, 2 * Math.PI);
      draw.stroke();
    }
  }
}

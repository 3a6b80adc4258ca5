// The map of regimes around the played scenario, and its cross-hair.
import { si } from "./controls.js";
import { paintAxes } from "./axes.js";
import { played } from "./bow.js";
import { MapRequest } from "./request.js";

const POINTS = 16;
const QUIET = 700; // Time without a change after which a map is computed [ms].
// Signs that distinguish regimes without colours.
const SIGNS = { "stable sliding": "", sticking: "–", "stick-slip": "/", squeal: "~", judder: "×", "off the track": "·" };

// The first axes: the one coefficient of friction over angle or force, else velocity and force.
export function axes(numbers, values) {
  const keys = numbers.map((one) => one.key);
  const { velocity, force } = played(numbers, values);
  const [friction, angle] = ["friction.coefficient", "slider.angle"].map((end) => keys.find((key) => key.endsWith(end)));
  const wanted = (friction ? [friction, angle ?? force?.key] : [velocity?.key, force?.key]).filter(Boolean);
  return [...wanted, ...keys.filter((key) => !wanted.includes(key))].slice(0, 2);
}

export class RegimeMap {
  constructor(scene, controls, regimes, say) {
    Object.assign(this, { scene, controls, regimes });
    this.canvas = document.getElementById("map");
    this.x = document.getElementById("map-x");
    this.y = document.getElementById("map-y");
    this.on = document.getElementById("map-on");
    this.words = document.getElementById("map-words");
    this.request = new MapRequest(POINTS, say, (words) => (this.words.textContent = words));
    this.known = "";
    for (const side of [this.x, this.y]) side.addEventListener("change", () => this.follow(this.revision, 0));
    this.on.addEventListener("change", () => this.follow(this.revision, 0));
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

  // Update to what plays at a revision: the keys to vary, and a new map unless only the cross-hair moved.
  follow(revision, delay = QUIET) {
    this.revision = revision;
    const numbers = this.controls.numbers();
    const [across, up] = axes(numbers, this.controls.values);
    this.#offer(this.x, numbers, across);
    this.#offer(this.y, numbers, up);
    const [a, b] = [this.side("x"), this.side("y")];
    if (!a || !b) return;
    const others = Object.entries(this.controls.values).filter(([key]) => key !== a.key && key !== b.key);
    const wanted = JSON.stringify([a.key, b.key, a.low, a.high, b.low, b.high, others, this.on.checked]);
    if (wanted === this.known) return;
    this.known = wanted;
    this.request.drop();
    this.words.textContent = this.slow && !this.on.checked ? "computed only on request: this system is slow" : "";
    if (!this.on.checked) return;
    const axis = ({ key, control, low, high }) => ({ key, low: si(low, control), high: si(high, control) });
    if (a.key === b.key) this.words.textContent = "choose two different quantities";
    else this.request.ask({ x: axis(a), y: axis(b) }, revision, delay);
  }

  // A change is on its way: a request around this setting must not be sent any more.
  leave() {
    if (!this.request.waits) return;
    this.request.drop();
    this.again();
  }

  // Slow systems are not computed hundreds of times except on request.
  rest(slow) {
    if (slow === Boolean(this.slow)) return;
    this.slow = slow;
    this.on.checked = !slow;
  }

  hold() {
    this.request.hold();
  }

  again() {
    this.known = "";
  }

  side(name) {
    const control = this.controls.numbers().find((one) => one.key === this[name].value);
    if (!control) return null;
    const value = this.controls.values[control.key] / control.scale;
    // Two axes that bound each other would move each other's ends.
    const both = [this.x, this.y].every(({ value: key }) => key in (this.controls.bounds ?? {}));
    const [least, most] = both ? [control.low, control.high] : this.controls.ends(control);
    // The sense of motion that is played.
    const [low, high] = least < 0 ? (value < 0 ? [least, Math.min(0, most)] : [0, most]) : [least, most];
    return { key: control.key, control, low: Math.min(low, value), high: Math.max(high, value) };
  }

  #offer(select, numbers, first) {
    const keys = numbers.map((one) => one.key);
    if (JSON.stringify(keys) === select.dataset.keys) return;
    const chosen = keys.includes(select.value) ? select.value : first;
    select.replaceChildren(...numbers.map((one) => new Option(one.label, one.key)));
    select.value = chosen;
    select.dataset.keys = JSON.stringify(keys);
  }

  take(row) {
    this.request.take(row);
  }

  done(map) {
    this.request.done(map);
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
    const shown = JSON.stringify([clientWidth, clientHeight, scale, colours.line, this.request.cells.size, this.known, sides, this.controls.values]);
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
    for (const [row, regimes] of this.request.cells) {
      regimes.forEach((name, column) => {
        const [x, y] = [left + column * w, top + height - (row + 1) * h];
        draw.fillStyle = this.regimes[name] ?? colours.panel;
        draw.fillRect(x, y, w + 0.5, h + 0.5);
        draw.fillStyle = isDark(this.regimes[name]) ? "#ffffff" : "#1b1f24";
        draw.textAlign = "center";
        draw.globalAlpha = 0.7;
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

function isDark(colour = "#000000") {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return 0.299 * red + 0.587 * green + 0.114 * blue < 120;
}

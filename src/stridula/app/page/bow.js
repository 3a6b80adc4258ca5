// Bowing and rubbing by hand: the speed of the hand along the picture is a velocity, moving down presses harder.
import { short } from "./axes.js";

export const TICK = 50; // Interval of messages [ms].
const SMOOTH = 0.5; // Weight of the hand's speed since the last tick in the played speed.
const HARDER = 16; // Factor of the force over the height of the picture.
const DIGITS = 3;
const VELOCITIES = /^drives\.[^.]+\.velocity$|\.surface_velocity$|\.track\.velocity$|\.turning$/;
const FORCES = /^drives\./;
const NEWTONS = /^[GMkmµn]?N$/;

// The controls played by hand, null if a system has none: the velocity, and the largest of the forces.
export function played(controls, values) {
  const size = ({ key }) => Math.abs(values[key]);
  const forces = controls.filter(({ key, unit }) => FORCES.test(key) && NEWTONS.test(unit)).sort((a, b) => size(b) - size(a));
  return { velocity: controls.find(({ key }) => VELOCITIES.test(key)) ?? null, force: forces[0] ?? null };
}

// A hand on the picture, in fractions of its width and height.
export class Hand {
  constructor({ velocity, force }, values, x, y) {
    Object.assign(this, { velocity, force, x, y });
    [this.lastX, this.firstY, this.speed] = [x, y, 0];
    this.pressed = force && (values[force.key] / force.scale || force.step);
  }

  moves(x, y) {
    Object.assign(this, { x, y });
  }

  // The values played after a time [ms], in SI, by key.
  tick(passed) {
    this.speed += SMOOTH * ((this.x - this.lastX) / (passed / 1000) - this.speed);
    this.lastX = this.x;
    const found = {};
    if (this.velocity) found[this.velocity.key] = within(this.velocity, this.#drawn());
    if (this.force) found[this.force.key] = within(this.force, this.pressed * HARDER ** (this.y - this.firstY));
    return found;
  }

  // One width per second is the fastest; a velocity of only one sign keeps it in both directions of the hand.
  #drawn() {
    const { low, high } = this.velocity;
    if (low < 0 && high > 0) return this.speed * Math.max(-low, high);
    return Math.abs(this.speed) * (low < 0 ? low : high);
  }
}

function within({ low, high, scale }, shown) {
  return Number((Math.max(low, Math.min(high, shown)) * scale).toPrecision(DIGITS)) + 0;
}

function inWords(what, values) {
  const played = Object.values(what).filter(Boolean);
  return played.map(({ key, unit, scale }) => `${short(values[key] / scale)} ${unit}`).join(", ");
}

// Bowing on a canvas: values return to their previous ones when the hand lets go.
export class Bow {
  constructor(canvas, scene, controls, tell) {
    Object.assign(this, { canvas, scene, controls, tell, hand: null });
    canvas.addEventListener("pointerdown", (event) => this.#grab(event));
    canvas.addEventListener("pointermove", (event) => this.hand?.moves(...this.#place(event)));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(end, () => this.release());
  }

  // Update to the scenario: whether there are controls for a hand.
  follow() {
    const { velocity, force } = this.#what();
    this.canvas.classList.toggle("bowed", Boolean(velocity || force));
    const words = this.canvas.hidden ? [] : [velocity && "across to bow", force && "down to press"].filter(Boolean);
    if (!this.hand) this.tell(words.length ? `drag: ${words.join(", ")}` : "");
  }

  release() {
    if (!this.hand) return;
    clearInterval(this.timer);
    this.hand = null;
    this.#set(this.before);
    this.follow();
  }

  #what() {
    return played(this.controls.numbers(), this.controls.values ?? {});
  }

  // Where the hand is in the window: notices that come and go move the canvas below it.
  #place({ clientX, clientY }) {
    return [clientX / this.canvas.clientWidth, clientY / this.canvas.clientHeight];
  }

  #grab(event) {
    const what = this.#what();
    if (this.hand || event.button !== 0 || !(what.velocity || what.force)) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.keys = [what.velocity, what.force].filter(Boolean).map(({ key }) => key);
    const { overrides } = this.scene.now;
    this.before = Object.fromEntries(this.keys.filter((key) => key in overrides).map((key) => [key, overrides[key]]));
    this.hand = new Hand(what, this.controls.values, ...this.#place(event));
    let last = performance.now();
    this.timer = setInterval(() => {
      const now = performance.now();
      const values = this.hand.tick(Math.max(1, now - last));
      last = now;
      this.#set(values);
      this.tell(inWords(what, values));
    }, TICK);
  }

  // Play other values of the controls of the hand, without steps of undo.
  #set(values) {
    const others = Object.entries(this.scene.now.overrides).filter(([key]) => !this.keys.includes(key));
    this.scene.set({ overrides: { ...Object.fromEntries(others), ...values } }, true);
  }
}

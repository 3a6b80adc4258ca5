// The viewpoint, which moves around the bodies by mouse, finger and keys.
import { cross, dot, unit } from "./surfaces.js";

const ELEVATION = Math.PI / 6;
const AZIMUTH = (7 * Math.PI) / 36;
const STEP = Math.PI / 36; // Step of an arrow key [rad].
const STEEPEST = Math.PI / 2 - 0.01;
const ZOOM = 1.15;
const [NEAREST, FARTHEST] = [0.15, 4];
const PASSES = 4; // Iterations that centre the bodies.
const DRAG = 0.008; // Angle per pixel [rad].

export class Orbit {
  constructor(canvas, onMove) {
    Object.assign(this, { canvas, onMove });
    this.pointers = new Map();
    this.home();
    canvas.addEventListener("keydown", (event) => this.#key(event));
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener("pointerdown", (event) => this.#press(event));
    canvas.addEventListener("pointermove", (event) => this.#drag(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(name, ({ pointerId }) => this.pointers.delete(pointerId));
    canvas.addEventListener("dblclick", () => this.home());
  }

  home() {
    Object.assign(this, { elevation: ELEVATION, azimuth: AZIMUTH, zoom: 1 });
    this.onMove?.();
  }

  // Initial directions to the right, up and to the eye, for the upward direction of the world,
  start(up) {
    return axesAt(up, AZIMUTH, ELEVATION);
  }

  // and present ones.
  axes(up) {
    return axesAt(up, this.azimuth, this.elevation);
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-STEEPEST, Math.min(STEEPEST, this.elevation + elevation));
    this.onMove();
  }

  scale(factor) {
    this.zoom = Math.max(NEAREST, Math.min(FARTHEST, this.zoom * factor));
    this.onMove();
  }

  #key(event) {
    const does = {
      ArrowLeft: () => this.turn(-STEP, 0),
      ArrowRight: () => this.turn(STEP, 0),
      ArrowUp: () => this.turn(0, STEP),
      ArrowDown: () => this.turn(0, -STEP),
      "+": () => this.scale(1 / ZOOM),
      "=": () => this.scale(1 / ZOOM),
      "-": () => this.scale(ZOOM),
      Home: () => this.home(),
    }[event.key];
    if (!does || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    does();
  }

  // The page scrolls unless the picture has the focus.
  #wheel(event) {
    if (document.activeElement !== this.canvas) return;
    event.preventDefault();
    this.scale(Math.exp(0.001 * event.deltaY));
  }

  #press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  #drag({ pointerId, clientX, clientY }) {
    const before = this.pointers.get(pointerId);
    if (!before) return;
    const apart = this.#apart();
    this.pointers.set(pointerId, [clientX, clientY]);
    if (this.pointers.size === 1) this.turn(-DRAG * (clientX - before[0]), DRAG * (clientY - before[1]));
    else if (apart) this.scale(apart / this.#apart());
  }

  #apart() {
    const [one, other] = [...this.pointers.values()];
    return other && Math.hypot(one[0] - other[0], one[1] - other[1]);
  }
}

function axesAt(up, azimuth, elevation) {
  const first = up[0] > 0.9 ? [0, 1, 0] : [1, 0, 0];
  const towards = cross(first, up);
  const [sine, cosine] = [Math.sin(azimuth), Math.cos(azimuth)];
  const level = towards.map((one, i) => cosine * one + sine * first[i]);
  const eye = level.map((one, i) => Math.cos(elevation) * one + Math.sin(elevation) * up[i]);
  const right = unit(cross(up, level));
  return { right, up: cross(eye, right), eye };
}

// Distance of the eye from the centre of places so that all are in sight, and that centre, in perspective.
export function fitted(places, start, axes, views) {
  let [middle, far] = [start, 0];
  for (let pass = 0; pass < PASSES; pass++) {
    far = Math.max(...places.map((those) => distanceTo(those, middle, axes, views)));
    const ends = places.flatMap((those) => endsOf(those, middle, axes, far));
    const shift = (far * (Math.min(...ends) + Math.max(...ends))) / 2;
    middle = middle.map((one, i) => one + shift * axes.up[i]);
  }
  return { middle, far };
}

function distanceTo(places, middle, { right, up, eye }, [across, upwards]) {
  let far = 0;
  for (let k = 0; k < places.length; k += 3) {
    const apart = [0, 1, 2].map((i) => places[k + i] - middle[i]);
    const depth = dot(apart, eye);
    far = Math.max(far, depth + Math.abs(dot(apart, right)) / across, depth + Math.abs(dot(apart, up)) / upwards);
  }
  return far;
}

// Lowest and highest slope of the lines of sight to places.
function endsOf(places, middle, { up, eye }, far) {
  let [low, high] = [Infinity, -Infinity];
  for (let k = 0; k < places.length; k += 3) {
    const apart = [0, 1, 2].map((i) => places[k + i] - middle[i]);
    const slope = dot(apart, up) / (far - dot(apart, eye));
    [low, high] = [Math.min(low, slope), Math.max(high, slope)];
  }
  return [low, high];
}

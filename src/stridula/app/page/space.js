// Systems in space: bodies coloured by the velocity out of their surfaces, contacts by their state, seen from any side.
import { roof, rounded } from "./axes.js";
import { fitted, Orbit } from "./orbit.js";
import { Body } from "./surfaces.js";

const VIBRATION = 0.05; // Size of the exaggerated vibration, as a fraction of the extent of the bodies.
const STILL = 1e-10; // Fraction of the extent below which nothing vibrates.
const STEADY = [0.005, 20]; // Time played [s], and number of pictures, of a running mean.
const FALL = 2000; // Time in which the scale of colours falls [ms].
const HALF_VIEW = Math.tan((15 * Math.PI) / 180);
const FILLED = 0.94;
const DOTS = [9, 13]; // Size of the dots of many contacts and of one [px].
const NO_WEBGL = "This browser has no WebGL 2, so bodies in space are not drawn. Everything else works.";
const NOT_LOADED = "The drawing in space could not be loaded. The next change tries again; everything else works.";
const STATES = ["separated", "sticking", "sliding"];
// From inwards through zero to outwards, as in films (RdBu of ColorBrewer, reversed).
const COLOURS = ["#053061", "#2166ac", "#4393c3", "#92c5de", "#d1e5f0", "#f7f7f7", "#fddbc7", "#f4a582", "#d6604d", "#b2182b", "#67001f"];
const SHADES = 256;

export class Space {
  constructor({ canvas, legend, low, high, missing }) {
    Object.assign(this, { canvas, legend, low, high, missing });
    this.orbit = new Orbit(canvas, () => (this.moved = true));
    this.bodies = [];
  }

  // Show or hide the view and create the drawing of a scene; nothing is loaded for scenes in the plane.
  async describe({ drawn, surfaces, touches, up }) {
    if (drawn === this.drawnAs) return;
    Object.assign(this, { drawnAs: drawn, ready: false, much: 0 });
    const isEmpty = drawn && !surfaces.length;
    if (drawn && !isEmpty) await (this.loading ??= this.#load());
    if (this.drawnAs !== drawn) return;
    const words = isEmpty ? "None of the bodies has a surface to draw." : this.isMissing ? NO_WEBGL : drawn && !this.renderer ? NOT_LOADED : "";
    if (words === NOT_LOADED) Object.assign(this, { loading: null, drawnAs: "" });
    this.canvas.hidden = this.legend.hidden = !drawn || Boolean(words);
    this.missing.hidden = !drawn || !words;
    this.missing.textContent = words;
    if (!drawn || words) return;
    this.#build({ surfaces, touches, up });
    this.ready = true;
  }

  async #load() {
    try {
      // A module that could not be loaded is asked for by another address: browsers remember the failure of the first.
      this.asked = (this.asked ?? 0) + 1;
      this.three ??= await import(`./vendor/three.module.min.js${this.asked > 1 ? `?${this.asked}` : ""}`);
      // Errors are reported here and not by the library.
      this.isSlow = isSoftware();
      const context = this.canvas.getContext("webgl2", { antialias: !this.isSlow, alpha: true });
      this.isMissing = !context;
      if (this.isMissing) return;
      this.renderer = new this.three.WebGLRenderer({ canvas: this.canvas, context });
      this.camera = new this.three.PerspectiveCamera(30, 1, 0.01, 100);
      this.colours = shades(this.three);
    } catch (error) {
      console.warn("the drawing in space could not be loaded:", error);
    }
  }

  #build(scene) {
    const three = this.three;
    this.world?.traverse(({ geometry, material }) => [geometry, material].forEach((one) => one?.dispose()));
    this.world = new three.Scene();
    this.bodies = scene.surfaces.map((one) => new Body(one));
    this.count = this.bodies.reduce((sum, { numbers }) => sum + numbers, 0);
    this.touches = scene.touches.map(({ body, row, place }) => body !== null && { body: this.bodies.find(({ name }) => name === body), row, place });
    this.up = scene.up;
    this.#measure();
    // The viewpoint is kept if the bodies are the same.
    const names = JSON.stringify(this.bodies.map(({ name }) => name));
    if (names !== this.names) this.orbit.home();
    this.names = names;
    this.sides = this.bodies.map((body) => this.#side(body));
    this.dots = this.#dots();
    const sky = new three.HemisphereLight(0xffffff, 0xb8bcc4, 1.9);
    sky.position.set(...this.up);
    this.sun = new three.DirectionalLight(0xffffff, 1.5);
    this.world.add(sky, this.sun, this.sun.target, ...this.sides.flatMap(({ mesh, edges }) => [mesh, edges]), this.dots);
    Object.assign(this, { steady: null, top: 0, exaggeration: 0, fitted: null, drawn: null });
  }

  // The initial centre of the picture, and the largest extent.
  #measure() {
    const { right, up, eye } = this.orbit.start(this.up);
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (const { surface: { place } } of this.bodies) {
      for (let k = 0; k < place.length; k += 3) {
        [right, up, eye].forEach((along, i) => {
          const value = along[0] * place[k] + along[1] * place[k + 1] + along[2] * place[k + 2];
          low[i] = Math.min(low[i], value);
          high[i] = Math.max(high[i], value);
        });
      }
    }
    const middle = low.map((one, i) => (one + high[i]) / 2);
    this.middle = right.map((_, i) => middle[0] * right[i] + middle[1] * up[i] + middle[2] * eye[i]);
    this.extent = Math.max(...high.map((one, i) => one - low[i]), 1e-6);
  }

  #side(body) {
    const three = this.three;
    const attribute = () => new three.BufferAttribute(new Float32Array(3 * body.source.length), 3).setUsage(three.DynamicDrawUsage);
    const [place, normal, colour] = [attribute(), attribute(), attribute()];
    const faces = new three.BufferGeometry().setIndex(new three.BufferAttribute(body.index, 1));
    faces.setAttribute("position", place).setAttribute("normal", normal).setAttribute("color", colour);
    const offset = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    const mesh = new three.Mesh(faces, new three.MeshLambertMaterial({ vertexColors: true, side: three.DoubleSide, ...offset }));
    const lines = new three.BufferGeometry().setIndex(new three.BufferAttribute(body.edges, 1)).setAttribute("position", place);
    const edges = new three.LineSegments(lines, new three.LineBasicMaterial({ color: 0x30353c, transparent: true, opacity: 0.55 }));
    mesh.frustumCulled = edges.frustumCulled = false;
    return { body, mesh, edges, place, normal, colour };
  }

  // Contacts lie between bodies and are drawn on top of them.
  #dots() {
    const three = this.three;
    const count = Math.max(1, this.touches.length);
    const geometry = new three.BufferGeometry();
    for (const name of ["position", "color"]) geometry.setAttribute(name, new three.BufferAttribute(new Float32Array(3 * count), 3));
    this.disc ??= new three.CanvasTexture(disc());
    const look = { map: this.disc, alphaTest: 0.4, transparent: true, depthTest: false, sizeAttenuation: false, vertexColors: true };
    const points = new three.Points(geometry, new three.PointsMaterial(look));
    Object.assign(points, { renderOrder: 2, frustumCulled: false });
    return points;
  }

  // Draw a part from coordinates, their rates and the states of the contacts; return the exaggeration.
  draw({ track, contacts }, clock, colours) {
    if (!this.ready || track.length !== 2 * this.count || this.canvas.hidden) return this.much ?? 0;
    if (track !== this.drawn) this.#move(track, contacts, clock, colours);
    else if (!this.moved && !this.#resized()) return this.much;
    this.drawn = track;
    this.again();
    return this.much;
  }

  // Redraw the last picture, which a browser keeps only until the next frame.
  again() {
    if (!this.ready) return;
    this.#look();
    this.renderer.render(this.world, this.camera);
    this.moved = false;
  }

  #move(track, contacts, clock, colours) {
    this.#follow(track, clock);
    let [at, most, fastest] = [0, 0, 0];
    for (const { body } of this.sides) {
      const [now, rates] = [0, this.count].map((first) => Array.from(track.subarray(first + at, first + at + body.numbers)));
      body.steady = Array.from(this.steady.subarray(at, at + body.numbers));
      most = Math.max(most, body.move(now, rates, body.steady));
      at += body.numbers;
    }
    const wanted = most > STILL * this.extent ? (VIBRATION * this.extent) / most : 0;
    // Rounded down, as in the plane.
    this.exaggeration = !this.exaggeration || wanted < this.exaggeration ? wanted : this.exaggeration * Math.min(1.01, wanted / this.exaggeration);
    this.much = this.exaggeration ? rounded(this.exaggeration) : 0;
    for (const side of this.sides) fastest = Math.max(fastest, this.#shape(side));
    this.#scale(fastest);
    for (const side of this.sides) this.#paint(side);
    this.#touch(contacts, colours);
  }

  // The mean about which the bodies vibrate.
  #follow(track, clock) {
    if (!this.steady) this.steady = track.slice(0, this.count);
    const share = 1 - Math.exp(-Math.min(1 / STEADY[1], Math.max(0, clock - (this.clock ?? clock)) / STEADY[0]));
    this.clock = clock;
    for (let k = 0; k < this.count; k++) this.steady[k] += share * (track[k] - this.steady[k]);
  }

  // Update corners and normals; return the largest velocity out of the surface.
  #shape({ body, place, normal }) {
    const { source, index, departed, mean, velocity } = body;
    const [to, out, much, rest] = [place.array, normal.array, this.much, body.surface.place];
    for (let k = 0, at = 0; k < source.length; k++) {
      for (let i = 0, from = 3 * source[k]; i < 3; i++, from++) to[at++] = rest[from] + mean[from] + much * departed[from];
    }
    out.fill(0);
    for (let t = 0; t < index.length; t += 3) {
      const [a, b, c] = [3 * index[t], 3 * index[t + 1], 3 * index[t + 2]];
      const [ux, uy, uz] = [to[b] - to[a], to[b + 1] - to[a + 1], to[b + 2] - to[a + 2]];
      const [vx, vy, vz] = [to[c] - to[a], to[c + 1] - to[a + 1], to[c + 2] - to[a + 2]];
      const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      for (const corner of [a, b, c]) {
        out[corner] += x;
        out[corner + 1] += y;
        out[corner + 2] += z;
      }
    }
    body.speeds ??= new Float32Array(source.length);
    let fastest = 0;
    for (let k = 0; k < source.length; k++) {
      const [at, from] = [3 * k, 3 * source[k]];
      const size = Math.hypot(out[at], out[at + 1], out[at + 2]) || 1;
      for (let i = 0; i < 3; i++) out[at + i] /= size;
      const speed = out[at] * velocity[from] + out[at + 1] * velocity[from + 1] + out[at + 2] * velocity[from + 2];
      body.speeds[k] = speed;
      fastest = Math.max(fastest, Math.abs(speed));
    }
    place.needsUpdate = normal.needsUpdate = true;
    return fastest;
  }

  // The scale of colours rises at once and falls slowly, in round numbers.
  #scale(fastest) {
    const now = performance.now();
    this.top = Math.max(fastest, this.top * Math.exp(((this.scaled ?? now) - now) / FALL), 1e-12);
    this.scaled = now;
    this.largest = roof(this.top);
    const words = speed(this.largest);
    if (this.high.textContent === words) return;
    this.high.textContent = words;
    this.low.textContent = `−${words}`;
  }

  #paint({ body, colour }) {
    const { array } = colour;
    const half = (SHADES - 1) / 2;
    for (let k = 0; k < body.speeds.length; k++) {
      const shade = 3 * Math.round(half * (1 + Math.max(-1, Math.min(1, body.speeds[k] / this.largest))));
      for (let i = 0; i < 3; i++) array[3 * k + i] = this.colours[shade + i];
    }
    colour.needsUpdate = true;
  }

  #touch(contacts, colours) {
    const { position, color } = this.dots.geometry.attributes;
    let drawn = 0;
    this.touches.forEach((one, k) => {
      if (!one?.body) return;
      position.array.set(one.body.touching(one.row, one.place, this.much, one.body.steady), 3 * drawn);
      const { r, g, b } = new this.three.Color(colours[STATES[contacts[2 * k]]]);
      color.array.set([r, g, b], 3 * drawn++);
    });
    this.dots.geometry.setDrawRange(0, drawn);
    this.dots.material.size = DOTS[drawn > 1 ? 0 : 1] * this.renderer.getPixelRatio();
    position.needsUpdate = color.needsUpdate = true;
  }

  #resized() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return this.fitted?.width !== width || this.fitted?.height !== height;
  }

  // Update the camera to the viewpoint.
  #look() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const { camera, orbit } = this;
    if (this.#resized()) {
      this.renderer.setPixelRatio(Math.min(this.isSlow ? 1 : 2, window.devicePixelRatio || 1));
      this.renderer.setSize(width, height, false);
      camera.aspect = width / Math.max(1, height);
      const views = [HALF_VIEW * camera.aspect * FILLED, HALF_VIEW * FILLED];
      this.fitted = { width, height, ...fitted(this.bodies.map(({ surface }) => surface.place), this.middle, orbit.start(this.up), views) };
    }
    const { eye, right, up } = orbit.axes(this.up);
    const { middle } = this.fitted;
    const far = this.fitted.far * orbit.zoom;
    const at = middle.map((one, i) => one + far * eye[i]);
    camera.up.set(...up);
    camera.position.set(...at);
    camera.lookAt(...middle);
    Object.assign(camera, { near: Math.max(far - 3 * this.extent, 0.02 * far), far: far + 3 * this.extent });
    camera.updateProjectionMatrix();
    this.sun.target.position.set(...middle);
    this.sun.position.set(...at.map((one, i) => one + far * (0.5 * up[i] - 0.4 * right[i])));
  }
}

// Whether rendering is done in software: then smooth edges would take most of the time.
function isSoftware() {
  const context = document.createElement("canvas").getContext("webgl2");
  const info = context?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? context.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

// Colours in linear components for the renderer, three numbers per shade.
function shades(three) {
  const stops = COLOURS.map((one) => new three.Color(one));
  const found = new Float32Array(3 * SHADES);
  for (let k = 0; k < SHADES; k++) {
    const place = (k / (SHADES - 1)) * (stops.length - 1);
    const from = Math.min(stops.length - 2, Math.floor(place));
    const { r, g, b } = stops[from].clone().lerp(stops[from + 1], place - from);
    found.set([r, g, b], 3 * k);
  }
  return found;
}

// A disc with a dark rim.
function disc() {
  const canvas = Object.assign(document.createElement("canvas"), { width: 64, height: 64 });
  const draw = canvas.getContext("2d");
  draw.beginPath();
  draw.arc(32, 32, 27, 0, 2 * Math.PI);
  draw.fillStyle = "#ffffff";
  draw.fill();
  draw.lineWidth = 8;
  draw.strokeStyle = "#14171b";
  draw.stroke();
  return canvas;
}

function speed(value) {
  const [unit, size] = [["m/s", 1], ["mm/s", 1e-3], ["µm/s", 1e-6]].find(([, size]) => value >= size * (1 - 1e-9)) ?? ["nm/s", 1e-9];
  return `${Number((value / size).toPrecision(3))} ${unit}`;
}

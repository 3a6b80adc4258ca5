// Bodies in space as numbers: the corners of their surfaces, and their motion in modes, without drawing.
const CREASE = Math.cos((35 * Math.PI) / 180); // Polygons that meet at smaller angles share normals.
const FEWEST_ANGLES = 60; // Fewest places around an axis,
const ANGLES_OF_WAVE = 5; // and places per wave.

// Arrays as encoded by the server: see `said` on its side.
export function heard({ shape, values }) {
  const bytes = Uint8Array.from(atob(values), (one) => one.charCodeAt(0));
  return { shape, values: new Float32Array(bytes.buffer) };
}

// Displacements from coordinates: rows (3 per corner) times coordinates.
function times({ values }, numbers, out) {
  const count = numbers.length;
  for (let row = 0, at = 0; row < out.length; row++) {
    let sum = 0;
    for (let k = 0; k < count; k++) sum += values[at++] * numbers[k];
    out[row] = sum;
  }
  return out;
}

// A surface of polygons.
class Polygons {
  constructor({ place, polygons, shapes }) {
    this.place = heard(place).values;
    this.shapes = heard(shapes);
    const { shape, values } = heard(polygons);
    this.faces = Array.from({ length: shape[0] }, (_, i) => Array.from(values.subarray(i * shape[1], (i + 1) * shape[1])));
  }

  moved(numbers, out) {
    return times(this.shapes, numbers, out);
  }
}

// A surface of revolution: a swept outline, with waves around the axis.
class Rings {
  constructor({ place, sides, shapes, orders, phases, frame, origin }) {
    this.shapes = heard(shapes);
    [this.orders, this.phases] = [heard(orders).values, heard(phases).values];
    this.frame = heard(frame).values;
    const outline = heard(place).values;
    this.points = outline.length / 2;
    const highest = this.orders.reduce((most, one) => Math.max(most, one), 0);
    this.angles = Math.max(FEWEST_ANGLES, ANGLES_OF_WAVE * highest);
    this.waves = [...new Set(this.orders)].map((order) => ({
      order,
      modes: [0, 1].map((phase) => [...this.orders.keys()].filter((k) => this.orders[k] === order && this.phases[k] === phase)),
      cosine: this.#round((angle) => Math.cos(order * angle)),
      sine: this.#round((angle) => Math.sin(order * angle)),
    }));
    this.directions = Array.from({ length: this.angles }, (_, a) => this.#directions((2 * Math.PI * a) / this.angles));
    const start = heard(origin).values;
    this.place = new Float32Array(3 * this.points * this.angles);
    for (let p = 0, at = 0; p < this.points; p++) {
      const [r, z] = [outline[2 * p], outline[2 * p + 1]];
      for (const [radial] of this.directions) for (let i = 0; i < 3; i++) this.place[at++] = start[i] + r * radial[i] + z * this.frame[6 + i];
    }
    this.faces = this.#faces(heard(sides).values, outline);
    this.amplitudes = new Float64Array(6 * this.points * this.waves.length);
  }

  #round(value) {
    return Float64Array.from({ length: this.angles }, (_, a) => value((2 * Math.PI * a) / this.angles));
  }

  #directions(angle) {
    const [cosine, sine, f] = [Math.cos(angle), Math.sin(angle), this.frame];
    return [[0, 1, 2].map((i) => cosine * f[i] + sine * f[3 + i]), [0, 1, 2].map((i) => cosine * f[3 + i] - sine * f[i])];
  }

  #faces(sides, outline) {
    const found = [];
    for (let s = 0; s < sides.length; s += 2) {
      const [start, end] = [sides[s] * this.angles, sides[s + 1] * this.angles];
      if (Math.max(outline[2 * sides[s]], outline[2 * sides[s + 1]]) <= 0) continue;
      for (let a = 0; a < this.angles; a++) {
        const b = (a + 1) % this.angles;
        found.push([start + a, start + b, end + b, end + a]);
      }
    }
    return found;
  }

  // Waves first, for all places around the axis at once.
  moved(numbers, out) {
    const { points, angles, waves, amplitudes, directions, frame } = this;
    const { values } = this.shapes;
    const count = numbers.length;
    let at = 0;
    for (const { modes } of waves) {
      for (let row = 0; row < 3 * points; row++) {
        for (const those of modes) {
          let sum = 0;
          for (const k of those) sum += values[row * count + k] * numbers[k];
          amplitudes[at++] = sum;
        }
      }
    }
    at = 0;
    for (let p = 0; p < points; p++) {
      for (let a = 0; a < angles; a++) {
        let [u, v, w] = [0, 0, 0];
        for (let n = 0; n < waves.length; n++) {
          const first = 6 * (n * points + p);
          const [cosine, sine] = [waves[n].cosine[a], waves[n].sine[a]];
          u += amplitudes[first] * cosine + amplitudes[first + 1] * sine;
          v += amplitudes[first + 2] * sine - amplitudes[first + 3] * cosine;
          w += amplitudes[first + 4] * cosine + amplitudes[first + 5] * sine;
        }
        const [radial, across] = directions[a];
        for (let i = 0; i < 3; i++) out[at++] = u * radial[i] + v * across[i] + w * frame[6 + i];
      }
    }
    return out;
  }
}

// A body with its surface, split along creases so that each side has its own normal.
export class Body {
  constructor(described) {
    const { name, numbers, rows } = described;
    Object.assign(this, { name, numbers, rows: heard(rows) });
    this.surface = described.polygons ? new Polygons(described) : new Rings(described);
    const { place, faces } = this.surface;
    const triangles = faces.flatMap(triangled).filter((one) => new Set(one).size === 3);
    this.departed = new Float32Array(place.length);
    this.velocity = new Float32Array(place.length);
    this.mean = new Float32Array(place.length);
    this.touched = new Float32Array(this.rows.shape[0] * 3);
    Object.assign(this, split(place, faces, triangles));
  }

  // Set the position from coordinates and their rates; steady coordinates move it to scale.
  move(numbers, rates, steady) {
    const apart = numbers.map((one, k) => one - steady[k]);
    this.surface.moved(apart, this.departed);
    this.surface.moved(rates, this.velocity);
    this.surface.moved(steady, this.mean);
    this.apart = apart;
    let most = 0;
    for (const value of this.departed) most = Math.max(most, Math.abs(value));
    return most;
  }

  // Position of a contact, with the deviation from the mean exaggerated.
  touching(row, place, much, steady) {
    return place.map((one, i) => {
      let sum = one;
      for (let k = 0, at = (3 * row + i) * this.numbers; k < this.numbers; k++) sum += this.rows.values[at + k] * (steady[k] + much * this.apart[k]);
      return sum;
    });
  }
}

// Triangles of a polygon; with midside nodes, each corner with the two beside it.
function triangled(corners) {
  if (corners.length < 6) return fan(corners);
  const middles = corners.filter((_, i) => i % 2);
  return [...fan(middles), ...middles.map((middle, i) => [middles.at(i - 1), corners[2 * i], middle])];
}

const fan = ([first, ...others]) => others.slice(1).map((other, i) => [first, others[i], other]);

// Corners once for each of their smooth parts, triangles by their numbers, and the edges between parts.
function split(place, faces, triangles) {
  const normals = triangles.map((corners) => unit(across(place, corners)));
  const around = Array.from({ length: place.length / 3 }, () => []);
  triangles.forEach((corners, t) => corners.forEach((corner) => around[corner].push(t)));
  const [source, index] = [[], new Uint32Array(3 * triangles.length)];
  around.forEach((those, corner) => {
    const groups = [];
    for (const t of those) {
      const near = groups.find(({ normal }) => dot(normal, normals[t]) > CREASE);
      const group = near ?? { normal: normals[t], number: source.push(corner) - 1 };
      if (!near) groups.push(group);
      index[3 * t + triangles[t].indexOf(corner)] = group.number;
    }
  });
  return { source: Uint32Array.from(source), index, edges: creases(faces, place, source) };
}

// Edges at which two polygons meet at an angle, by the numbers of split corners.
function creases(faces, place, source) {
  const first = new Map(source.map((corner, number) => [corner, number]).reverse());
  const met = new Map();
  for (const corners of faces) {
    const normal = unit(round(place, corners));
    corners.forEach((one, i) => {
      const other = corners[(i + 1) % corners.length];
      const key = one < other ? `${one} ${other}` : `${other} ${one}`;
      met.set(key, [...(met.get(key) ?? []), normal]);
    });
  }
  const sharp = [...met].filter(([, those]) => those.length === 1 || dot(those[0], those[1]) < CREASE);
  return Uint32Array.from(sharp.flatMap(([key]) => key.split(" ").map((corner) => first.get(Number(corner)) ?? 0)));
}

function across(place, [a, b, c]) {
  const side = (from, to) => [0, 1, 2].map((i) => place[3 * to + i] - place[3 * from + i]);
  return cross(side(a, b), side(a, c));
}

function round(place, corners) {
  return corners.slice(2).reduce((sum, _, i) => across(place, [corners[0], corners[i + 1], corners[i + 2]]).map((one, k) => sum[k] + one), [0, 0, 0]);
}

export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
export const dot = (one, other) => one.reduce((sum, value, i) => sum + value * other[i], 0);
export const unit = (vector) => {
  const size = Math.hypot(...vector) || 1;
  return vector.map((one) => one / size);
};

// Systems other than two beams: lines, points, connections, tracks and all contacts.
const VIBRATION = 0.06; // Size of the exaggerated vibration, as a fraction of the picture's extent.
const STILL = 1e-9; // Fraction of the extent below which nothing vibrates.
const SMALLEST = 1e-3; // Extent of a system without one [m].
const GROUND = 0.3; // Distance of a point from the ground of its spring, as a fraction of the extent.
const BLOCK = 14; // Size of the block drawn for a point [px].
const MARGIN = 28;

// Positions of one frame in metres: places to scale, and deviations from them.
export function placed(scene, values) {
  let at = 0;
  return scene.lines.map(({ places, count }) => {
    const [dx, dy] = values.subarray(at, (at += 2));
    const apart = places.map((_, i) => [values[at + 2 * i], values[at + 2 * i + 1]]);
    at += 2 * places.length;
    return { places: places.map(([x, y]) => [x + dx, y + dy]), apart, count };
  });
}

// The box around the motion of a system so far, and the largest deviation now.
export class Frame {
  constructor() {
    this.box = null;
    this.exaggeration = 0;
  }

  follow(lines, scene) {
    let [left, low, right, high] = this.box ?? [Infinity, Infinity, -Infinity, -Infinity];
    let most = 0;
    for (const { places, apart } of lines) {
      for (const [x, y] of places) [left, low, right, high] = [Math.min(left, x), Math.min(low, y), Math.max(right, x), Math.max(high, y)];
      for (const [x, y] of apart) most = Math.max(most, Math.abs(x), Math.abs(y));
    }
    for (const { ends, along } of scene.joined) {
      if (ends.length > 1 || !scene.lines[ends[0][0]].slides) continue;
      const [x, y] = wallOf(scene, ends[0], along, this.extent ?? 0);
      [left, low, right, high] = [Math.min(left, x), Math.min(low, y), Math.max(right, x), Math.max(high, y)];
    }
    this.box = [left, low, right, high];
    this.extent = Math.max(right - left, high - low, SMALLEST);
    const wanted = most > STILL * this.extent ? (VIBRATION * this.extent) / most : 0;
    // Rounded down, so that nothing leaves the picture.
    const before = this.exaggeration;
    this.exaggeration = !before || !wanted || wanted < before ? wanted : before * Math.min(1.01, wanted / before);
    return this.exaggeration;
  }

  // From metres to pixels in a picture.
  to(width, height) {
    const [left, low, right, high] = this.box;
    const room = 2 * VIBRATION * this.extent;
    const [wide, tall] = [Math.max(right - left, 0.5 * this.extent) + room, Math.max(high - low, 0.1 * this.extent) + room];
    const scale = Math.min((width - 2 * MARGIN) / wide, (height - 2 * MARGIN) / tall);
    const [x0, y0] = [(left + right) / 2, (low + high) / 2];
    return ([x, y]) => [width / 2 + scale * (x - x0), height / 2 - scale * (y - y0)];
  }
}

// Draw a frame; much is the rounded exaggeration.
export function drawLines(draw, scene, lines, contacts, at, much, colours, states, extent) {
  const drawn = lines.map(({ places, apart, count }) => ({
    points: places.map(([x, y], i) => at([x + much * apart[i][0], y + much * apart[i][1]])),
    rest: places.map(at),
    count,
  }));
  draw.lineWidth = 1;
  draw.strokeStyle = colours.soft;
  for (const { ends, along } of scene.joined) {
    const [one, other] = ends.map(([line, row]) => drawn[line].points[row]);
    // A support of a point on another body would be drawn over that body.
    if (!other && !scene.lines[ends[0][0]].slides) continue;
    const wall = wallOf(scene, ends[0], along, extent);
    if (other) {
      coil(draw, other, one);
      continue;
    }
    // At half the height of the block of a point.
    const [x, y] = at(wall);
    coil(draw, [x, y - BLOCK / 2], [one[0], one[1] - BLOCK / 2]);
    path(draw, [-1, 1].map((s) => [x + s * BLOCK * along[1], y - BLOCK / 2 - s * BLOCK * along[0]]));
  }
  draw.strokeStyle = colours.line;
  draw.setLineDash([4, 4]);
  for (const { rest, count } of drawn) if (count > 1) path(draw, rest.slice(0, count));
  draw.setLineDash([]);
  scene.contacts.forEach((contact, i) => contact.passes && passing(draw, contact, contacts[2 * i + 1], mark(contact, lines, much), at, colours, extent));
  drawn.forEach(({ points, count }, i) => {
    const isTip = scene.contacts.some(({ tip }) => tip[0] === i);
    draw.strokeStyle = draw.fillStyle = isTip ? colours.mark : colours.ink;
    draw.lineWidth = 4;
    if (count > 1) path(draw, points.slice(0, count));
    else draw.fillRect(points[0][0] - BLOCK / 2, points[0][1] - BLOCK, BLOCK, BLOCK);
  });
  const size = scene.contacts.length === 1 ? 8 : 5;
  scene.contacts.forEach((contact, i) => {
    draw.beginPath();
    draw.arc(...at(mark(contact, lines, much)), size, 0, 2 * Math.PI);
    draw.fillStyle = colours[states[contacts[2 * i]]];
    draw.fill();
    draw.lineWidth = 1.2;
    draw.strokeStyle = colours.ink;
    draw.stroke();
  });
}

// Position of the mark of a contact: the touched point, else the sliding tip.
export function mark({ tip, touched }, lines, much) {
  const [line, row] = touched ?? tip;
  const { places, apart } = lines[line];
  return [places[row][0] + much * apart[row][0], places[row][1] + much * apart[row][1]];
}

// Position of the ground of a spring.
function wallOf(scene, [line, row], along, extent) {
  const [x, y] = scene.lines[line].places[row];
  return [x - GROUND * extent * along[0], y - GROUND * extent * along[1]];
}

// A spring or a dashpot from one point to another.
function coil(draw, [x0, y0], [x1, y1]) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [nx, ny] = [(-5 * (y1 - y0)) / length, (5 * (x1 - x0)) / length];
  const turns = Array.from({ length: 13 }, (_, i) => [(i + 1) / 14, i % 2 ? 1 : -1]);
  path(draw, [[x0, y0], ...turns.map(([t, side]) => [x0 + t * (x1 - x0) + side * nx, y0 + t * (y1 - y0) + side * ny]), [x1, y1]]);
}

// A moving surface: a line with strokes that move with it.
function passing(draw, { normal, tangent, touched }, travel, [x, y], at, colours, extent) {
  const reach = touched ? 0.1 * extent : extent;
  const [gap, long] = [0.06 * extent, 0.02 * extent];
  const inwards = touched ? 1 : -1;
  const point = (s, d) => at([x + s * tangent[0] + d * inwards * normal[0], y + s * tangent[1] + d * inwards * normal[1]]);
  draw.strokeStyle = colours.soft;
  draw.lineWidth = 1.5;
  path(draw, [point(-reach, 0), point(reach, 0)]);
  draw.lineWidth = 1;
  // The position of the surface does not depend on that of the tip.
  const along = touched ? travel : travel - (x * tangent[0] + y * tangent[1]);
  const first = Math.ceil((-reach - along) / gap) * gap + along;
  for (let s = first; s <= reach; s += gap) path(draw, [point(s, 0), point(s - long, long)]);
}

function path(draw, points) {
  draw.beginPath();
  points.forEach(([x, y], i) => (i ? draw.lineTo(x, y) : draw.moveTo(x, y)));
  draw.stroke();
}

// Normal force over time, and below it the state of the contact.
import { Layer, paintAxes, roof } from "./axes.js";
import { legend } from "./spectra.js";

export const WINDOW = 1.0; // Time shown live [s].
const FALL = 400; // Time in which an axis shrinks [ms].
const LANE = 11; // Height of the ribbon of a state [px].
const [LEFT, RIGHT, ABOVE, BELOW] = [50, 10, 6, 32];

// The top of an axis rises at once to the largest value and soon falls to it.
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

export class Timeline {
  constructor() {
    this.top = new Top();
    this.axes = new Layer();
  }

  // The force of the other setting, if it is held, ends at the same place as that of the playing one.
  draw([draw, width, height], history, slow, colours, states, held = null) {
    const span = WINDOW / slow;
    const points = history.since(span);
    const lanes = states.length * LANE + 4;
    const [inner, tall] = [width - LEFT - RIGHT, height - ABOVE - BELOW - lanes];
    let largest = 1e-9;
    for (const k of points) largest = Math.max(largest, history.force[k]);
    const reference = held ? held.force.filter(([time]) => time >= -span) : [];
    for (const [, force] of reference) largest = Math.max(largest, force);
    const top = roof(this.top.follow(largest, performance.now()));
    this.axes.draw(draw, width, height, [top, span, colours.line], (paint) => this.#axes(paint, { inner, tall, lanes, top, span }, colours, states));
    const start = history.clock - span;
    const x = (k) => LEFT + ((history.time[k] - start) / span) * inner;
    const y = (value) => ABOVE + tall * (1 - value / top);
    const columns = columnsOf(points, history, x);
    draw.fillStyle = draw.strokeStyle = colours.trace;
    draw.lineWidth = 1.5;
    if (points.length < inner) path(draw, points.map((k) => [x(k), y(history.force[k])]));
    else envelope(draw, columns, y);
    states.forEach((name, state) => ribbon(draw, columns, 1 << state, ABOVE + tall + 5 + LANE * state, colours[name]));
    if (!reference.length) return;
    draw.strokeStyle = colours.held;
    draw.lineWidth = 1;
    path(draw, thinned(reference.map(([time, force]) => [LEFT + (1 + time / span) * inner, y(force)])));
    legend(draw, [{ name: `${held.name}, held`, colour: colours.held, wide: 1, dashed: false }], { left: LEFT, top: ABOVE, width: inner }, colours, 1);
  }

  #axes(draw, { inner, tall, lanes, top, span }, colours, states) {
    const [scale, unit] = span < 0.1 ? [1000, "ms"] : [1, "s"];
    // The numbers of time are below the ribbons.
    paintAxes(draw, { left: LEFT, top: ABOVE, width: inner, height: tall }, { x: { low: 0, high: 0, title: "" }, y: { low: 0, high: top, title: "force [N]" } }, colours);
    const under = { left: LEFT, top: ABOVE, width: inner, height: tall + lanes };
    paintAxes(draw, under, { x: { low: -span * scale, high: 0, title: `time before now [${unit}]` }, y: { low: 0, high: 0, title: "" } }, colours);
    draw.fillStyle = colours.line;
    states.forEach((_, state) => draw.fillRect(LEFT, ABOVE + tall + 14 + LANE * state, inner, 0.5));
  }
}

// The largest and the smallest point in each column, so that no peak is lost.
function columnsOf(points, history, x) {
  const columns = new Map();
  for (const k of points) {
    const column = Math.floor(x(k));
    const one = columns.get(column) ?? { low: Infinity, high: -Infinity, states: 0 };
    one.low = Math.min(one.low, history.force[k]);
    one.high = Math.max(one.high, history.force[k]);
    one.states |= 1 << history.state[k];
    columns.set(column, one);
  }
  return columns;
}

// The lowest and the highest point of each column.
export function thinned(points) {
  const columns = new Map();
  for (const point of points) {
    const column = Math.floor(point[0]);
    const one = columns.get(column) ?? [point, point];
    columns.set(column, [point[1] < one[0][1] ? point : one[0], point[1] > one[1][1] ? point : one[1]]);
  }
  return [...columns.values()].flatMap((both) => (both[0] === both[1] ? [both[0]] : both.sort((one, other) => one[0] - other[0])));
}

function envelope(draw, columns, y) {
  let before = null;
  for (const [column, { low, high }] of columns) {
    const [up, down] = before ? [Math.max(high, before.low), Math.min(low, before.high)] : [high, low];
    draw.fillRect(column, y(up), 1, Math.max(1.2, y(down) - y(up)));
    before = { low, high };
  }
}

function ribbon(draw, columns, bit, top, colour) {
  draw.fillStyle = colour;
  let from = null;
  for (const [column, { states }] of columns) {
    if (states & bit) {
      const start = from === null ? column : Math.max(LEFT, from + 1);
      draw.fillRect(start, top, column - start + 1, LANE - 2);
    }
    from = column;
  }
}

export function path(draw, points) {
  draw.beginPath();
  points.forEach(([x, y], i) => (i ? draw.lineTo(x, y) : draw.moveTo(x, y)));
  draw.stroke();
}

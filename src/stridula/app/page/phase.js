// The phase portrait of the tip: its velocity over its displacement.
import { inWords, Layer, paintAxes, roof } from "./axes.js";

const PORTRAIT = 0.06; // Time shown live [s]
const SHORTEST = 4e-4; // and shortest time.
const SHRINK = 0.97; // Factor by which the axes shrink per picture.
const DEEP_YELLOW = "#8a7f00"; // Sliding on a light ground.
const [STICKING, SLIDING] = [1, 2];
const [LEFT, RIGHT, ABOVE, BELOW] = [58, 12, 6, 32];

export class Phase {
  constructor() {
    this.axes = new Layer();
  }

  draw([draw, width, height], history, slow, colours, states, dark) {
    const points = history.since(slow === 1 ? PORTRAIT : Math.max(PORTRAIT / slow, SHORTEST), history.begun);
    if (points.length < 2) return;
    // Travel at the mean velocity does not count as vibration.
    const [first, last] = [points[0], points.at(-1)];
    const drift = (history.place[last] - history.place[first]) / Math.max(1e-9, history.time[last] - history.time[first]);
    const across = points.map((k) => history.place[k] - drift * (history.time[k] - history.time[first]));
    const [low, high] = [Math.min(...across), Math.max(...across)];
    let fastest = 1e-9;
    for (const k of points) fastest = Math.max(fastest, Math.abs(history.speed[k]));
    this.half = follow(this.half, Math.max((high - low) / 2, 1e-12));
    this.fastest = follow(this.fastest, fastest);
    const [half, most] = [roof(1.1 * this.half), roof(1.1 * this.fastest)];
    const box = { left: LEFT, top: ABOVE, width: width - LEFT - RIGHT, height: height - ABOVE - BELOW };
    const sticks = points.every((k) => history.state[k] === STICKING);
    this.axes.draw(draw, width, height, [half, most, sticks, colours.line], (paint) => {
      const [scale, unit] = half < 1e-3 ? [1e6, "µm"] : [1e3, "mm"];
      const [speed, per] = most < 0.1 ? [1e3, "mm/s"] : [1, "m/s"];
      const sides = {
        x: { low: -half * scale, high: half * scale, title: `displacement [${unit}]` },
        y: { low: -most * speed, high: most * speed, title: `velocity [${per}]` },
      };
      // Axes without motion are not shown.
      if (!sticks) paintAxes(paint, box, sides, colours);
      else inWords(paint, box, ["The tip sticks:", "it does not move", "along the track."], colours);
    });
    if (sticks) return;
    const x = (value) => box.left + (box.width / 2) * (1 + (value - (low + high) / 2) / half);
    const y = (value) => box.top + (box.height / 2) * (1 - value / most);
    draw.lineWidth = 1.3;
    for (let i = 1; i < points.length; i++) {
      const state = history.state[points[i]];
      draw.globalAlpha = 0.15 + (0.85 * i) / points.length;
      draw.strokeStyle = dark || state !== SLIDING ? colours[states[state]] : DEEP_YELLOW;
      draw.beginPath();
      draw.moveTo(x(across[i - 1]), y(history.speed[points[i - 1]]));
      draw.lineTo(x(across[i]), y(history.speed[points[i]]));
      draw.stroke();
    }
    draw.globalAlpha = 1;
  }
}

function follow(before, wanted) {
  return before && before > wanted ? Math.max(wanted, SHRINK * before) : wanted;
}

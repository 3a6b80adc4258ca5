// The phase portrait of the tip: its velocity over its displacement.
import { inWords, Layer, paintAxes, roof } from "./axes.js";
import { Top } from "./timeline.js";

const PORTRAIT = 0.06; // Time shown live [s]
const SHORTEST = 4e-4; // and shortest time.
const LEAST = 0.1; // Smallest side of the axis of velocity, as a fraction of the other one.
const DEEP_YELLOW = "#8a7f00"; // Sliding on a light ground.
const [STICKING, SLIDING] = [1, 2];
const [LEFT, RIGHT, ABOVE, BELOW] = [58, 12, 6, 32];

// The ends of an axis that includes zero, each of which rises at once and soon falls.
export class Ends {
  constructor() {
    this.tops = [new Top(), new Top()];
  }

  follow(low, high, now) {
    const [down, up] = [-low, high].map((end, i) => this.tops[i].follow(Math.max(end, 1e-9), now));
    return [-roof(Math.max(down, LEAST * up)), roof(Math.max(up, LEAST * down))];
  }
}

export class Phase {
  constructor() {
    this.axes = new Layer();
    this.half = new Top();
    this.speeds = new Ends();
  }

  draw([draw, width, height], history, slow, colours, states, dark) {
    const points = history.since(slow === 1 ? PORTRAIT : Math.max(PORTRAIT / slow, SHORTEST), history.begun);
    if (points.length < 2) return;
    // Travel at the mean velocity does not count as vibration.
    const [first, last] = [points[0], points.at(-1)];
    const drift = (history.place[last] - history.place[first]) / Math.max(1e-9, history.time[last] - history.time[first]);
    const across = points.map((k) => history.place[k] - drift * (history.time[k] - history.time[first]));
    const [low, high] = [Math.min(...across), Math.max(...across)];
    let [slowest, fastest] = [0, 0];
    for (const k of points) [slowest, fastest] = [Math.min(slowest, history.speed[k]), Math.max(fastest, history.speed[k])];
    const now = performance.now();
    const half = roof(this.half.follow(Math.max((high - low) / 2, 1e-12), now));
    const [least, most] = this.speeds.follow(slowest, fastest, now);
    const box = { left: LEFT, top: ABOVE, width: width - LEFT - RIGHT, height: height - ABOVE - BELOW };
    const sticks = points.every((k) => history.state[k] === STICKING);
    this.axes.draw(draw, width, height, [half, least, most, sticks, colours.line], (paint) => {
      const [scale, unit] = half < 1e-3 ? [1e6, "µm"] : [1e3, "mm"];
      const [speed, per] = Math.max(most, -least) < 0.1 ? [1e3, "mm/s"] : [1, "m/s"];
      const sides = {
        x: { low: -half * scale, high: half * scale, title: `displacement [${unit}]` },
        y: { low: least * speed, high: most * speed, title: `velocity [${per}]` },
      };
      // Axes without motion are not shown.
      if (!sticks) paintAxes(paint, box, sides, colours);
      else inWords(paint, box, ["The tip sticks:", "it does not move", "along the track."], colours);
    });
    if (sticks) return;
    const x = (value) => box.left + (box.width / 2) * (1 + (value - (low + high) / 2) / half);
    const y = (value) => box.top + (box.height * (most - value)) / (most - least);
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

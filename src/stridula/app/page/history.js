// Force, state and motion of the displayed contact, as far back as the pictures show.
const KEPT = 1 << 15; // Number of points kept.

export class History {
  constructor() {
    this.force = new Float32Array(KEPT);
    this.state = new Uint8Array(KEPT);
    this.time = new Float64Array(KEPT);
    this.place = new Float64Array(KEPT);
    this.speed = new Float32Array(KEPT);
    this.count = 0;
    this.begun = 0; // Start of the stroke.
  }

  // Add the points of a part.
  take({ clock, stroke, place, interval }, [force, state, moved, speed]) {
    // A restarted server counts time from zero.
    if (clock < this.clock) this.count = this.begun = 0;
    const seen = force.length;
    for (let i = 0; i < seen; i++) {
      const k = this.count++ % KEPT;
      this.force[k] = force[i];
      this.state[k] = state[i];
      this.place[k] = place + moved[i];
      this.speed[k] = speed[i];
      this.time[k] = clock - (seen - 1 - i) * interval;
    }
    if (stroke !== this.stroke) this.begun = this.count - seen;
    this.clock = clock;
    this.stroke = stroke;
  }

  // Points of the last seconds, from a given one on.
  since(seconds, begun = 0) {
    const first = Math.max(begun, this.count - KEPT + 1, 0);
    const found = [];
    for (let n = this.count - 1; n >= first; n--) {
      const k = n % KEPT;
      if (this.time[k] < this.clock - seconds) break;
      found.push(k);
    }
    return found.reverse();
  }

  // The present state.
  get now() {
    return this.state[(this.count - 1) % KEPT];
  }
}

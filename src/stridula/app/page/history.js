// Force, state and motion of the contact that is shown, as far back as pictures go.
const KEPT = 1 << 15; // Points that are kept.

export class History {
  constructor() {
    this.force = new Float32Array(KEPT);
    this.state = new Uint8Array(KEPT);
    this.time = new Float64Array(KEPT);
    this.place = new Float64Array(KEPT);
    this.speed = new Float32Array(KEPT);
    this.count = 0;
    this.begun = 0; // Where the stroke began.
  }

  // Take over what was seen in a part.
  take({ clock, stroke, place, interval }, [force, state, moved, speed]) {
    // A server that began anew counts its time from the start.
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

  // Points of the last seconds, not before one of them.
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

  // The state now.
  get now() {
    return this.state[(this.count - 1) % KEPT];
  }
}

// How much sound is kept ahead: more while drop-outs go on, and less again after a while without one.
const LEAST = 0.08; // [s]
const MOST = 0.3; // [s]
const MORE = 0.02; // How much more after a drop-out [s].
const LESS = 0.005; // How much less after each calm while [s].
const CALM = 20000; // [ms]
const RECENT = 10000; // [ms]

export class Queue {
  constructor() {
    this.length = LEAST;
    this.last = -Infinity; // When the last drop-out was, or something was let go after it [ms].
    this.dropped = -Infinity;
  }

  drop(now) {
    this.length = Math.min(MOST, this.length + MORE);
    this.last = this.dropped = now;
  }

  // Let go of what is no longer needed.
  rest(now) {
    while (this.length > LEAST && now - this.last >= CALM) {
      this.length = Math.max(LEAST, this.length - LESS);
      this.last += CALM;
    }
  }

  // Whether the longest queue is not long enough.
  isBehind(now) {
    return this.length > MOST - 2 * LESS && now - this.dropped < RECENT;
  }
}

// Length of the queued sound: longer while drop-outs continue, shorter again after a time without one.
const LEAST = 0.3; // [s]
const MOST = 0.44; // [s]
const MORE = 0.02; // Increase after a drop-out [s].
const LESS = 0.005; // Decrease after each calm period [s].
const CALM = 20000; // [ms]
const RECENT = 10000; // [ms]

export class Queue {
  constructor() {
    this.length = LEAST;
    this.last = -Infinity; // Time of the last drop-out or the last decrease after it [ms].
    this.dropped = -Infinity;
  }

  drop(now) {
    this.length = Math.min(MOST, this.length + MORE);
    this.last = this.dropped = now;
  }

  // Shorten the queue if possible.
  rest(now) {
    while (this.length > LEAST && now - this.last >= CALM) {
      this.length = Math.max(LEAST, this.length - LESS);
      this.last += CALM;
    }
  }

  // Length in addition to that of a machine that keeps up.
  get extra() {
    return this.length - LEAST;
  }

  // Whether even the longest queue is too short.
  isBehind(now) {
    return this.length > MOST - 2 * LESS && now - this.dropped < RECENT;
  }
}

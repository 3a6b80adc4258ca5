// The request for a map: sent after a quiet time, suspended in favour of the sound, and answered row by row.
const HELD = 5000; // Time without a drop-out after which a suspended map continues [ms].
const PATIENCE = 5000; // Time without a row after which the wait is explained [ms].
const WAIT = "computing the first row; the first map of all compiles code, which takes up to a minute";

export class MapRequest {
  constructor(points, say, tell) {
    Object.assign(this, { points, say, tell, cells: new Map(), asked: null, waits: false, holds: false });
  }

  // Ask after a time for a map around what plays at a revision, in place of the last one.
  ask(sides, revision, delay) {
    this.drop();
    this.waits = true;
    this.timer = setTimeout(() => {
      Object.assign(this, { waits: false, asked: revision });
      this.tell("computing");
      this.say({ type: "map", revision, ...sides, points: this.points });
      this.timer = setTimeout(() => this.tell(WAIT), PATIENCE);
    }, delay);
  }

  // Forget the map, whether it waits, is computed or is complete.
  drop() {
    clearTimeout(this.timer);
    if (this.asked !== null) this.say({ type: "no map" });
    Object.assign(this, { waits: false, asked: null, holds: false });
    this.cells.clear();
  }

  // Suspend the map after the row that is computed, until there was no drop-out for a time.
  hold() {
    if (this.asked === null) return;
    clearTimeout(this.timer);
    if (!this.holds) this.say({ type: "hold map", on: true });
    this.holds = true;
    this.tell("suspended in favour of the sound");
    this.timer = setTimeout(() => this.#goOn(), HELD);
  }

  #goOn() {
    this.holds = false;
    this.say({ type: "hold map", on: false });
    this.tell(this.#progress);
  }

  get #progress() {
    return this.cells.size ? `${Math.round((100 * this.cells.size) / this.points)} % computed` : "computing";
  }

  take({ revision, row, regimes }) {
    if (revision !== this.asked) return;
    this.cells.set(row, regimes);
    if (this.holds) return;
    clearTimeout(this.timer);
    this.tell(this.#progress);
  }

  done({ revision }) {
    if (revision !== this.asked) return;
    clearTimeout(this.timer);
    this.asked = null;
    this.tell("runs of up to 1 s from the start");
  }
}

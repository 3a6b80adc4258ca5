// Two settings to switch between, A and B, each with its own scene and undo.
export class Slots {
  constructor(scene) {
    this.scene = scene;
    this.heard = "A";
    this.other = null; // The setting that is not playing, once there is one.
  }

  // Play one of them; the second begins as a copy of the first.
  go(name) {
    if (name === this.heard) return;
    this.scene.onLeave();
    const other = this.other ?? { now: structuredClone(this.scene.now), past: [], future: [] };
    this.other = this.scene.whole;
    this.heard = name;
    this.scene.take(other);
  }

  // Set both at once and play the first.
  set(first, second) {
    this.other = { now: second, past: [], future: [] };
    this.heard = "A";
    this.scene.set(first);
  }
}

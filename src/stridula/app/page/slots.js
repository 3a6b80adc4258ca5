// Two settings to switch between, A and B, each with its own scene and undo.
export class Slots {
  // Before the other one plays, onGo is told the name of the one that stops; before both are set anew, null.
  constructor(scene, onGo = () => {}) {
    Object.assign(this, { scene, onGo });
    this.heard = "A";
    this.other = null; // The setting that is not playing, once there is one.
  }

  // Play one of them; the second begins as a copy of the first.
  go(name) {
    if (name === this.heard) return;
    this.scene.onLeave();
    this.onGo(this.heard);
    const other = this.other ?? { now: structuredClone(this.scene.now), past: [], future: [] };
    this.other = this.scene.whole;
    this.heard = name;
    this.scene.take(other);
  }

  // Set both at once and play the first.
  set(first, second) {
    this.onGo(null);
    this.other = { now: second, past: [], future: [] };
    this.heard = "A";
    this.scene.set(first);
  }
}

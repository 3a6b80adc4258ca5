// The guided tour: for each stop a setting, a few sentences, and a picture to look at.
export class Tour {
  constructor(stops, scene, slots) {
    Object.assign(this, { stops, scene, slots, at: null });
    const $ = (name) => document.getElementById(name);
    [this.panel, this.where, this.title, this.words] = ["tour", "tour-where", "tour-title", "tour-words"].map($);
    [this.back, this.next] = [$("tour-back"), $("tour-next")];
    $("tour-begin").addEventListener("click", () => this.go(0));
    this.back.addEventListener("click", () => this.go(this.at - 1));
    this.next.addEventListener("click", () => (this.at + 1 < this.stops.length ? this.go(this.at + 1) : this.leave()));
    $("tour-leave").addEventListener("click", () => this.leave());
  }

  go(at) {
    document.dispatchEvent(new CustomEvent("guided", { detail: "tour" }));
    this.at = at;
    const { title, words, look, case: name, overrides, compared } = this.stops[at];
    this.panel.hidden = false;
    this.where.textContent = `Stop ${at + 1} of ${this.stops.length}`;
    this.title.textContent = title;
    this.words.textContent = words;
    this.back.disabled = at === 0;
    this.next.textContent = at + 1 < this.stops.length ? "Next" : "End";
    const played = { case: name, text: null, overrides: { ...overrides } };
    if (compared) this.slots.set(played, { ...played, overrides: { ...compared } });
    else this.scene.set(played);
    this.#mark(document.getElementById(look).closest("figure"));
    this.next.focus({ preventScroll: true });
  }

  // The scene is kept.
  leave() {
    if (this.panel.hidden) return;
    this.panel.hidden = true;
    this.#mark(null);
    document.getElementById("tour-begin").focus();
  }

  #mark(meant) {
    for (const one of document.querySelectorAll("figure.meant")) one.classList.remove("meant");
    meant?.classList.add("meant");
    meant?.scrollIntoView({ block: "nearest" });
  }
}

// The scene as stored in the address bar: a case or a text, and values by key, with undo.
const KEEP = 100;
const FIRST = "glass"; // It sings within a moment.

export class Scene {
  // Before another scene is played, onLeave ends movements in progress.
  constructor(onChange, onLeave = () => {}) {
    Object.assign(this, { onChange, onLeave });
    this.now = { case: FIRST, text: null, overrides: {} };
    this.past = [];
    this.future = [];
    this.challenge = null; // Name of the challenge that a link has, too.
    this.places = {}; // Keys for which a key with a * stands.
  }

  // Change the scene; a continuous movement is one step of undo.
  set(next, goesOn = false) {
    if (!goesOn) {
      this.onLeave();
      this.#remember();
    }
    this.now = { ...this.now, ...next };
    this.onChange();
  }

  // Change some values, by key.
  values(some, goesOn = false) {
    if (!goesOn) this.onLeave();
    this.set({ overrides: { ...this.now.overrides, ...some } }, goesOn);
  }

  // Restore refused values, unless they were changed again since.
  putBack(sent, refused, kept) {
    if ("" in refused) {
      if (sent.case === this.now.case && sent.text === this.now.text) this.now = { ...structuredClone(kept), case: kept.text === null ? kept.case : "" };
      return;
    }
    const overrides = { ...this.now.overrides };
    for (const key of Object.keys(refused)) {
      if (!(key in overrides) || overrides[key] !== sent.overrides[key]) continue;
      if (key in kept.overrides) overrides[key] = kept.overrides[key];
      else delete overrides[key];
    }
    this.now = { ...this.now, overrides };
  }

  // A table of another kind: values of the old kind are removed.
  kind(key, value, begins) {
    this.onLeave();
    const table = key.slice(0, key.lastIndexOf(".") + 1);
    const kept = Object.entries(this.now.overrides).filter(([name]) => key.startsWith("simulation") || !name.startsWith(table));
    this.set({ overrides: { ...Object.fromEntries(kept), [key]: value, ...begins } });
  }

  // The scene with its undo and redo steps, to be restored later.
  get whole() {
    return structuredClone({ now: this.now, past: this.past, future: this.future });
  }

  take({ now, past, future }) {
    Object.assign(this, { now, past, future });
    this.onChange();
  }

  #remember() {
    const last = this.past.at(-1);
    if (last && same(last, this.now)) return;
    this.past.push(structuredClone(this.now));
    this.past = this.past.slice(-KEEP);
    this.future = [];
  }

  undo() {
    this.onLeave();
    while (this.past.length && same(this.past.at(-1), this.now)) this.past.pop();
    if (this.past.length) this.#go(this.past, this.future);
  }

  redo() {
    this.onLeave();
    if (this.future.length) this.#go(this.future, this.past);
  }

  #go(from, to) {
    to.push(structuredClone(this.now));
    this.now = from.pop();
    this.onChange();
  }

  get canUndo() {
    return this.past.some((one) => !same(one, this.now));
  }

  get canRedo() {
    return this.future.length > 0;
  }

  // The command that runs the same scenario.
  command() {
    const words = Object.entries(this.now.overrides).flatMap(([key, value]) => (this.places[key] ?? [key]).map((one) => `--set ${quoted(`${one}=${value}`)}`));
    return ["stridula run", this.now.text === null ? this.now.case : "scenario.toml", ...words].join(" ");
  }

  async link() {
    const words = new URLSearchParams();
    if (this.now.text === null) words.set("case", this.now.case);
    else words.set("text", await packed(this.now.text));
    for (const [key, value] of Object.entries(this.now.overrides)) words.set(key, value);
    if (this.challenge) words.set("challenge", this.challenge);
    return `#${words}`;
  }

  // Read a link; values that it lacks are those of the case.
  async read(hash) {
    const words = new URLSearchParams(hash.replace(/^#/, ""));
    this.challenge = words.get("challenge");
    // A challenge alone begins with its case.
    this.hasSetting = [...words.keys()].some((key) => key !== "challenge");
    if (!this.hasSetting) return false;
    const next = { case: words.get("case") ?? (words.has("text") ? "" : "squeal"), text: null, overrides: {} };
    if (words.has("text")) next.text = await unpacked(words.get("text"));
    for (const [key, value] of words) {
      if (["case", "text", "challenge"].includes(key)) continue;
      const number = Number(value);
      next.overrides[key] = value.trim() !== "" && Number.isFinite(number) ? number : value;
    }
    this.onLeave();
    if (same(next, this.now)) return false;
    this.#remember();
    this.now = next;
    return true;
  }
}

function same(one, other) {
  return one.case === other.case && one.text === other.text && JSON.stringify(one.overrides) === JSON.stringify(other.overrides);
}

function quoted(text) {
  return /^[\w.=+-]+$/.test(text) ? text : `'${text}'`;
}

async function through(stream, bytes) {
  const out = new Response(new Blob([bytes]).stream().pipeThrough(stream));
  return new Uint8Array(await out.arrayBuffer());
}

async function packed(text) {
  const bytes = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(text));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function unpacked(word) {
  const bytes = Uint8Array.from(atob(word.replaceAll("-", "+").replaceAll("_", "/")), (one) => one.charCodeAt(0));
  return new TextDecoder().decode(await through(new DecompressionStream("deflate-raw"), bytes));
}

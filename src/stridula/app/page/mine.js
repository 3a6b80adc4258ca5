// Your glass beside the computed one: the microphone, its spectrum and pitch, and the wall that has that pitch.
import { Microphone } from "./microphone.js";
import { reading } from "./note.js";

const EACH = 100; // Interval between moments [ms].

export class Mine {
  constructor({ pictures, say, scene, show }) {
    Object.assign(this, { pictures, say, scene, show, microphone: new Microphone(), frequency: null, fits: false });
    const $ = (id) => document.getElementById(id);
    [this.button, this.words, this.panel, this.yours, this.ours, this.fit, this.fitted] = ["microphone", "microphone-words", "mine", "mine-pitch", "ours-pitch", "fit", "fit-words"].map($);
    this.button.addEventListener("click", () => (this.microphone.on ? this.stop() : this.start()));
    this.fit.addEventListener("click", () => this.#fit());
  }

  async start() {
    this.button.disabled = true;
    const why = await this.microphone.start(() => this.stop("The microphone has ended: it was unplugged or taken away."));
    this.button.disabled = false;
    this.#tell(why);
    if (why) return;
    this.show();
    this.#turn(true);
    this.timer = setInterval(() => this.#listen(), EACH);
  }

  stop(why = "") {
    clearInterval(this.timer);
    this.microphone.stop();
    this.pictures.mine = this.frequency = null;
    this.#turn(false);
    this.#tell(why);
  }

  // The system that plays may have a wall to fit; a result for one before it is void.
  follow(fits, goesOn) {
    this.fits = fits;
    this.fit.hidden = !fits;
    if (!goesOn && !this.isFitted) this.fitted.textContent = "";
    this.isFitted = false;
  }

  // The pitch that the headline names.
  computed(frequency) {
    this.ours.textContent = inWords(frequency) || "no tone";
  }

  // The answer of the server.
  took({ overrides, words }) {
    this.#busy(false);
    this.fitted.textContent = words;
    if (!Object.keys(overrides).length) return;
    this.isFitted = true;
    this.scene.values(overrides);
  }

  #fit() {
    if (this.frequency === null) {
      this.fitted.textContent = "No pitch is heard: rub or tap the glass near the microphone.";
      return;
    }
    this.#busy(true);
    this.fitted.textContent = `Searching for the wall with ${Math.round(this.frequency)} Hz, which takes some seconds …`;
    this.say({ type: "fit", frequency: this.frequency });
  }

  // Nothing comes of a request if another setting plays.
  forget() {
    if (this.fit.disabled) this.fitted.textContent = "";
    this.#busy(false);
  }

  #busy(is) {
    this.fit.disabled = is;
  }

  #listen() {
    this.pictures.mine = this.microphone.read();
    const { frequency } = this.pictures.mine;
    // While the button is pressed the tone may have ended.
    if (frequency !== null) this.frequency = frequency;
    this.yours.textContent = frequency === null ? (this.frequency === null ? "no tone" : `${inWords(this.frequency)}, before`) : inWords(frequency);
  }

  #turn(on) {
    this.button.setAttribute("aria-pressed", String(on));
    this.panel.hidden = !on;
  }

  #tell(words) {
    this.words.textContent = words;
    this.words.hidden = words === "";
  }
}

// A pitch with its note, empty without one.
export function inWords(frequency) {
  const { note } = reading(frequency, []);
  return note ? `${frequency.toFixed(frequency < 1000 ? 1 : 0)} Hz, ${note}` : "";
}

// Challenges for a class: a task, judged by the server from the motion that the headline names, and a tick once reached.
const KEY = "challenges reached"; // In the storage of the browser.

export class Challenges {
  constructor(all, { scene, say, copied, problem, note }) {
    Object.assign(this, { all, scene, say, problem, note, at: null, handed: false, broken: false });
    const $ = (name) => document.getElementById(`challenge-${name}`);
    [this.where, this.title, this.words, this.held, this.time, this.verdict, this.hint] = ["where", "title", "words", "held", "time", "verdict", "hint"].map($);
    [this.panel, this.dialog, this.list] = ["challenge", "challenges", "challenge-cards"].map((name) => document.getElementById(name));
    this.done = stored();
    document.getElementById("challenges-open").addEventListener("click", () => this.choose());
    $("all").addEventListener("click", () => this.choose());
    $("again").addEventListener("click", () => this.take(this.at.name));
    $("leave").addEventListener("click", () => this.leave());
    $("link").addEventListener("click", () => copied());
    $("forget").addEventListener("click", () => this.#forget());
    this.#show();
  }

  // Open the list of challenges.
  choose() {
    this.dialog.showModal();
    (this.list.querySelector("[aria-current]") ?? this.list.querySelector("button")).focus();
  }

  // Begin a challenge from its case.
  take(name) {
    this.#open(this.all.find((one) => one.name === name));
    this.scene.set({ case: this.at.case, text: null, overrides: {} });
    this.handed = this.broken = false;
    this.#say();
    this.panel.querySelector("button").focus({ preventScroll: true });
  }

  // The challenge of a link, with its setting, or from its case if the link has none.
  read(name, hasSetting) {
    if (!name) {
      this.leave();
      return;
    }
    const found = this.all.find((one) => one.name === name);
    if (!found) {
      this.scene.challenge = null;
      this.problem([`The link has a challenge that this version does not know: ${name}`]);
      return;
    }
    if (!hasSetting) {
      this.take(name);
      return;
    }
    this.#open(found);
    [this.handed, this.broken] = [true, false];
    this.#say();
  }

  leave() {
    if (!this.at) return;
    this.at = this.scene.challenge = null;
    if (this.panel.contains(document.activeElement)) document.getElementById("challenges-open").focus();
    this.panel.hidden = true;
    this.say({ type: "challenge", name: null });
    this.note();
  }

  // Another server has not been told of the challenge.
  again() {
    if (this.at) this.say({ type: "challenge", name: this.at.name });
  }

  // Another setting plays, no longer that of a link.
  changed() {
    if (!this.at) return;
    this.handed = this.broken = false;
    this.#say();
  }

  // Values of a link were refused: another setting plays, about which a verdict would say nothing.
  refused() {
    this.broken = this.handed;
  }

  // Show the verdict of the server.
  judge(verdict) {
    if (!this.at || verdict?.name !== this.at.name) return;
    if (this.broken) this.#say("The setting of this link cannot be played as a whole, so it is not judged.");
    else if (verdict.reached) this.#reached(verdict);
    else this.#say(this.#inWords(verdict), verdict.held, verdict.hold);
  }

  #reached({ hold }) {
    this.#say(this.handed ? "✓ The setting of this link meets the challenge." : "✓ Reached.", hold, hold);
    if (this.handed || this.done.has(this.at.name)) return;
    this.done.add(this.at.name);
    this.#keep();
  }

  #inWords({ words, judged }) {
    const now = words || "It meets the challenge: hold it.";
    if (!this.handed) return now;
    return judged ? `The setting of this link does not meet the challenge. ${now}` : `Judging the setting of this link. ${now}`;
  }

  #open(challenge) {
    document.dispatchEvent(new CustomEvent("guided", { detail: "challenge" }));
    this.dialog.close();
    this.at = challenge;
    this.scene.challenge = challenge.name;
    this.panel.hidden = false;
    this.title.textContent = challenge.title;
    this.words.textContent = challenge.words;
    this.hint.textContent = challenge.hint;
    this.hint.closest("details").open = false;
    this.say({ type: "challenge", name: challenge.name });
    this.#show();
  }

  #say(words = this.handed ? "Judging the setting of this link." : "Listening …", held = 0, hold = 1) {
    // A text that is written again would be read aloud again.
    if (this.verdict.textContent !== words) this.verdict.textContent = words;
    this.panel.classList.toggle("reached", words.startsWith("✓"));
    Object.assign(this.held, { value: held, max: hold });
    this.time.textContent = held > 0 ? `held ${held.toFixed(1)} of ${hold} s` : "";
  }

  // The list, with ticks.
  #show() {
    this.list.replaceChildren(
      ...this.all.map((one) => {
        const item = document.createElement("li");
        const button = Object.assign(document.createElement("button"), { type: "button", textContent: one.title });
        if (one === this.at) button.setAttribute("aria-current", "true");
        const tick = Object.assign(document.createElement("span"), { className: "tick", textContent: this.done.has(one.name) ? "✓ reached" : "" });
        button.append(" ", tick);
        button.addEventListener("click", () => this.take(one.name));
        item.append(button);
        return item;
      }),
    );
    const reached = this.all.filter(({ name }) => this.done.has(name)).length;
    document.getElementById("challenge-count").textContent = `${reached} of ${this.all.length} reached`;
    const number = this.all.indexOf(this.at) + 1;
    this.where.textContent = number ? `Challenge ${number} of ${this.all.length}${this.done.has(this.at.name) ? ", reached ✓" : ""}` : "";
  }

  #forget() {
    this.done.clear();
    this.#keep();
  }

  #keep() {
    try {
      localStorage.setItem(KEY, JSON.stringify([...this.done]));
    } catch {
      // Without storage the ticks last as long as the page.
    }
    this.#show();
  }
}

// The names of the challenges reached before.
export function stored() {
  try {
    const found = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    return new Set(Array.isArray(found) ? found.filter((one) => typeof one === "string") : []);
  } catch {
    return new Set();
  }
}

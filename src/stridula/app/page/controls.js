// The controls, built from their description by the server: the main ones first, the others in groups behind *More*;
// those that a scenario lacks are hidden.
import { played } from "./bow.js";

// The keys of the main controls: friction, the velocity or else the angle, and the force.
export function mainKeys(numbers, values) {
  const keys = numbers.map(({ key }) => key);
  const { velocity, force } = played(numbers, values);
  const friction = keys.find((key) => /friction\.(coefficient|static)$/.test(key));
  const speed = velocity?.key ?? keys.find((key) => key.endsWith("slider.angle"));
  return [friction, force?.key, speed].filter(Boolean);
}

export class Controls {
  constructor(form, hello, scene) {
    this.scene = scene;
    this.form = form;
    form.addEventListener("submit", (event) => event.preventDefault());
    this.build(hello);
  }

  // Build the controls of a kind of system.
  build(hello) {
    const form = this.form;
    this.rows = new Map();
    this.values = undefined;
    this.main = fieldset("Main controls");
    this.arranged = "";
    this.more = document.createElement("details");
    this.more.id = "more";
    this.more.open = localStorage.getItem("more") === "1";
    this.more.addEventListener("toggle", () => localStorage.setItem("more", this.more.open ? "1" : "0"));
    this.more.append(Object.assign(document.createElement("summary"), { textContent: "More" }));
    for (const group of hello.groups) {
      const field = fieldset(group);
      for (const control of hello.controls.filter((one) => one.group === group)) this.#number(control, field);
      for (const choice of hello.choices.filter((one) => one.group === group)) this.#choice(choice, field);
      this.more.append(field);
    }
    form.replaceChildren(this.main, this.more);
  }

  // Put the main controls first, and the others into their groups, if others are the main ones now.
  #arrange(main) {
    if (this.arranged === String(main)) return;
    this.arranged = String(main);
    for (const [key, { row, field }] of this.rows) if (!main.includes(key)) field.append(row);
    for (const key of main) this.main.append(this.rows.get(key).row);
  }

  #number(control, field) {
    const id = idOf(control.key);
    const row = document.createElement("div");
    row.className = "control";
    row.innerHTML = `<label for="${id}"></label>
      <div class="row"><input type="range" id="${id}-slide"><input type="number" id="${id}"><span class="unit"></span></div>
      <p class="refused" role="alert" hidden></p><p class="words" id="${id}-words"></p>`;
    const [label, slide, number, unit, words] = ["label", "[type=range]", "[type=number]", ".unit", ".words"].map((one) => row.querySelector(one));
    const named = control.unit ? `${control.label} in ${spoken(control.unit)}` : control.label;
    label.textContent = control.label;
    unit.textContent = control.unit;
    words.textContent = control.words;
    for (const input of [slide, number]) {
      Object.assign(input, { min: control.low, max: control.high, step: control.step });
      input.setAttribute("aria-label", input === slide ? `${named}, slider` : named);
      input.setAttribute("aria-describedby", `${id}-words`);
      input.dataset.key = control.key;
    }
    number.removeAttribute("min");
    number.removeAttribute("max");
    number.step = "any";
    let moving = false;
    slide.addEventListener("input", () => {
      number.value = slide.value;
      this.scene.values({ [control.key]: si(Number(slide.value), control) }, moving);
      moving = true;
    });
    slide.addEventListener("change", () => (moving = false));
    number.addEventListener("change", () => {
      if (number.value.trim() === "" || !Number.isFinite(Number(number.value))) this.show(this.values, true);
      else this.scene.values({ [control.key]: si(Number(number.value), control) });
    });
    const show = (value, again, ends) => this.#show(value, slide, number, control, again, ends);
    this.rows.set(control.key, { row, field, control, show });
  }

  #show(value, slide, number, control, again, [low, high]) {
    const shown = Number((value / control.scale).toPrecision(7));
    slide.min = Math.min(low, shown);
    slide.max = Math.max(high, shown);
    if (again || document.activeElement !== slide || Math.abs(Number(slide.value) - shown) > control.step) slide.value = shown;
    if (again || document.activeElement !== number) number.value = shown;
    slide.setAttribute("aria-valuetext", `${shown} ${spoken(control.unit)}`.trim());
  }

  #choice(choice, field) {
    const id = idOf(choice.key);
    const row = document.createElement("div");
    row.className = "control";
    row.innerHTML = `<label class="field" for="${id}"></label><select id="${id}"></select><p class="refused" role="alert" hidden></p><p class="words" id="${id}-words"></p>`;
    row.querySelector("label").textContent = choice.label;
    row.querySelector(".words").textContent = choice.words;
    const select = row.querySelector("select");
    select.setAttribute("aria-describedby", `${id}-words`);
    for (const [value, word] of Object.entries(choice.kinds)) select.append(new Option(word, value));
    select.addEventListener("change", () => this.scene.kind(choice.key, select.value, choice.begins[select.value]));
    const show = (value) => {
      if (![...select.options].some((one) => one.value === value)) select.append(new Option(value, value));
      select.value = value;
    };
    this.rows.set(choice.key, { row, field, show });
  }

  // Show the played values, and the ends of sliders that they bound, given in SI.
  show(values, again = false, bounds = this.bounds) {
    const before = this.values ?? {};
    const moved = JSON.stringify(bounds) !== JSON.stringify(this.bounds);
    Object.assign(this, { values, bounds });
    for (const [key, { row, show, control }] of this.rows) {
      row.hidden = !(key in values);
      if (key in values && (again || moved || values[key] !== before[key])) show(values[key], again, control && this.ends(control));
    }
    this.#arrange(mainKeys(this.numbers(), values));
    for (const field of this.more.querySelectorAll("fieldset")) field.hidden = !field.querySelector(".control:not([hidden])");
  }

  // The ends of a slider, in the unit shown.
  ends({ key, low, high, scale }) {
    return this.bounds?.[key]?.map((end) => Number((end / scale).toPrecision(7))) ?? [low, high];
  }

  // Show beside each control why it was refused, and its played value; return refused keys without a control.
  refuse(refused) {
    for (const [key, { row, show, control }] of this.rows) {
      const words = row.querySelector(".refused");
      words.hidden = !(key in refused);
      words.textContent = (refused[key] ?? []).join("\n");
      if (key in refused && this.more.contains(row)) this.more.open = true;
      if (key in refused && key in (this.values ?? {})) show(this.values[key], true, control && this.ends(control));
    }
    return Object.keys(refused).filter((key) => !this.rows.has(key) || this.rows.get(key).row.hidden);
  }

  numbers() {
    return [...this.rows.values()].filter(({ control, row }) => control && !row.hidden).map(({ control }) => control);
  }
}

function fieldset(legend) {
  const field = document.createElement("fieldset");
  field.append(Object.assign(document.createElement("legend"), { textContent: legend }));
  return field;
}

function idOf(key) {
  return key.replaceAll(/[^\w]/g, "-");
}

export function si(shown, control) {
  return Number((shown * control.scale).toPrecision(12));
}

function spoken(unit) {
  return { "°": "degrees", mm: "millimetres", N: "newtons", "cm/s": "centimetres per second", "mm/s": "millimetres per second", "%": "percent" }[unit] ?? unit;
}

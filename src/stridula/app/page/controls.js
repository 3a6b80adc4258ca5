// The controls, built in groups from their description by the server; those that a scenario lacks are hidden.
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
    form.replaceChildren();
    for (const group of hello.groups) {
      const field = document.createElement("fieldset");
      field.append(Object.assign(document.createElement("legend"), { textContent: group }));
      // The most used controls come first.
      for (const control of hello.controls.filter((one) => one.group === group)) field.append(this.#number(control));
      for (const choice of hello.choices.filter((one) => one.group === group)) field.append(this.#choice(choice));
      form.append(field);
    }
  }

  #number(control) {
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
    this.rows.set(control.key, { row, control, show });
    return row;
  }

  #show(value, slide, number, control, again, [low, high]) {
    const shown = Number((value / control.scale).toPrecision(7));
    slide.min = Math.min(low, shown);
    slide.max = Math.max(high, shown);
    if (again || document.activeElement !== slide || Math.abs(Number(slide.value) - shown) > control.step) slide.value = shown;
    if (again || document.activeElement !== number) number.value = shown;
    slide.setAttribute("aria-valuetext", `${shown} ${spoken(control.unit)}`.trim());
  }

  #choice(choice) {
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
    this.rows.set(choice.key, { row, show });
    return row;
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
      if (key in refused && key in (this.values ?? {})) show(this.values[key], true, control && this.ends(control));
    }
    return Object.keys(refused).filter((key) => !this.rows.has(key) || this.rows.get(key).row.hidden);
  }

  numbers() {
    return [...this.rows.values()].filter(({ control, row }) => control && !row.hidden).map(({ control }) => control);
  }
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

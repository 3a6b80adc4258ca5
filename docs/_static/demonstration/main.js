// Connects map, sliders, picture and sound of the demonstration.
"use strict";
(function () {
  const { Sound, scale, Body, RegimeMap } = window.stridulaDemonstration;
  const SECONDS = 2; // A period of the pitch in the picture.
  const root = document.getElementById("demonstration");
  const data = JSON.parse(document.getElementById("demonstration-data").textContent);
  const part = (name) => root.querySelector(`[data-part="${name}"]`);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const sound = new Sound();
  let instrument, body, factor, place, colours;
  let [moving, phase, before, pending, visible] = [!still.matches, 0, 0, 0, true];

  const setting = () => instrument.settings[place[0] * instrument.y.values.length + place[1]];
  const digits = (value, count = 3) => Number(value.toPrecision(count)).toLocaleString("en", { useGrouping: false });
  const shown = (axis, k) => `${digits(axis.values[k])}${axis.unit && " "}${axis.unit}`;
  const map = new RegimeMap(part("map"), (column, row) => choose([column, row]));

  /** Return what a setting does, in words. */
  function words({ regime, pitch, level }) {
    if (level === null) return `${data.words[regime]}: silent`;
    return data.words[regime].replace("{}", `${digits(pitch)} Hz`);
  }

  /** Return what is heard of a setting, in words. */
  function heard({ level, share, base, repeated }) {
    if (level === null) return "This setting makes no sound.";
    const loop = repeated ? `; irregular: ${digits(1000 / base)} ms of the run are repeated` : "";
    const tones = share > 0.99 ? "" : `; the tones that you hear carry ${digits(100 * share, 2)} % of its power`;
    return `${Math.round(level)} dB at 1 m${loop}${tones}.`;
  }

  function choose(next) {
    if (place && next[0] === place[0] && next[1] === place[1]) return;
    place = next;
    for (const [k, name] of ["x", "y"].entries()) {
      const [slider, text] = [part(name), shown(instrument[name], place[k])];
      slider.value = place[k];
      slider.setAttribute("aria-valuetext", text);
      part(`${name}-value`).textContent = text;
    }
    sound.play(setting(), factor);
    phase = moving ? phase : body.farthest(setting());
    say();
    redraw();
  }

  function say() {
    const one = setting();
    part("now").textContent = words(one);
    part("heard").textContent = heard(one);
    const slow = one.base ? `, ${digits(one.pitch * SECONDS, 2)} times as slow` : "";
    const { exaggeration } = instrument.body;
    part("scale").textContent = one.motion.length
      ? `${instrument.motion}, drawn ${digits(exaggeration, 2)} times as large${slow}`
      : "At rest but for the sliding, which is not drawn.";
    part("body").setAttribute("aria-label", `${instrument.title}: ${words(one)}`);
  }

  function play(name) {
    instrument = data.instruments.find((one) => one.name === name);
    factor = scale(instrument.settings);
    body = new Body(part("body"), instrument.body);
    for (const axis of ["x", "y"]) {
      part(axis).max = instrument[axis].values.length - 1;
      part(`${axis}-label`).textContent = instrument[axis].label;
    }
    const names = [...new Set(instrument.settings.map((one) => one.regime))];
    part("legend").replaceChildren(...names.map((regime) => {
      const item = document.createElement("li");
      item.style.setProperty("--colour", data.colours[regime]);
      item.textContent = regime;
      return item;
    }));
    const loud = instrument.settings.filter((one) => one.level !== null).length;
    const axes = `${instrument.x.label} to the right, ${instrument.y.label} upwards`;
    part("map").setAttribute("aria-label", `${loud} of ${instrument.settings.length} settings sound. ${axes}.`);
    place = null;
    choose(instrument.start);
  }

  /** Take colours from the theme of the page. */
  function theme() {
    const style = getComputedStyle(root), dark = document.documentElement.dataset.theme === "dark";
    const ink = style.getPropertyValue("color");
    const [light, deep] = dark ? [[70, 92, 112], [255, 176, 90]] : [[196, 212, 224], [213, 94, 0]];
    colours = {
      ink,
      mark: "#e69f00",
      line: dark ? "#8cc4f0" : "#1f4e79",
      edge: dark ? "#0006" : "#1f4e7933",
      face: (facing, far) => {
        const bright = 0.72 + 0.28 * Math.abs(facing);
        return `rgb(${light.map((value, k) => Math.round(bright * (value + (deep[k] - value) * far))).join()})`;
      },
    };
    redraw();
  }

  /** Give canvases the pixels of their size on the screen. */
  function fit() {
    for (const canvas of [part("body"), part("map")]) {
      const box = canvas.getBoundingClientRect(), ratio = Math.min(devicePixelRatio, 2);
      const size = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
      if (canvas.width !== size[0]) canvas.width = size[0];
      if (canvas.height !== size[1]) canvas.height = size[1];
    }
    redraw();
  }

  function redraw() {
    if (!instrument || !place || !colours) return;
    map.draw(instrument, data.colours, place);
    pending ||= requestAnimationFrame(draw);
  }

  function draw(time) {
    pending = 0;
    const runs = moving && visible && setting().motion.length > 0;
    const { base, pitch } = setting();
    if (runs) phase += (2 * Math.PI * (base / pitch) * Math.min((time - before) / 1000, 0.1)) / SECONDS;
    before = time;
    body.draw(setting(), phase, colours);
    if (runs) pending = requestAnimationFrame(draw);
  }

  function move(on) {
    moving = on;
    part("move").textContent = on ? "Hold still" : "Move";
    if (!on) phase = body.farthest(setting());
    redraw();
  }

  part("x").addEventListener("input", (event) => choose([Number(event.target.value), place[1]]));
  part("y").addEventListener("input", (event) => choose([place[0], Number(event.target.value)]));
  part("move").addEventListener("click", () => move(!moving));
  part("sound").addEventListener("click", async () => {
    const on = !sound.on;
    await sound.turn(on);
    part("sound").setAttribute("aria-pressed", String(on));
    part("sound").textContent = on ? "Sound off" : "Sound on";
    if (on) sound.play(setting(), factor);
  });
  for (const input of root.querySelectorAll("input[name=demonstration-case]")) {
    input.addEventListener("change", () => play(input.value));
  }
  still.addEventListener("change", () => move(!still.matches));
  new MutationObserver(theme).observe(document.documentElement, { attributeFilter: ["data-theme"] });
  new ResizeObserver(fit).observe(root);
  new IntersectionObserver(([entry]) => {
    visible = entry.isIntersecting;
    redraw();
  }).observe(root);
  root.hidden = false;
  play(root.querySelector("input[name=demonstration-case]:checked").value);
  move(moving);
  theme();
  fit();
  window.stridulaDemonstration.playing = { sound, choose, play, setting };
})();

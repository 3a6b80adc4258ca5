// The page: shows messages of the server, and sends it the actions of the user.
import { short } from "./axes.js";
import { Bow } from "./bow.js";
import { Challenges } from "./challenges.js";
import { Controls } from "./controls.js";
import { Gallery } from "./gallery.js";
import { RegimeMap } from "./map.js";
import { levelWords } from "./level.js";
import { Loop } from "./loop.js";
import { Mine } from "./mine.js";
import { parts } from "./parts.js";
import { reading } from "./note.js";
import { Pictures } from "./pictures.js";
import { Recorder } from "./recorder.js";
import { Scene } from "./scene.js";
import { Slots } from "./slots.js";
import { Sound } from "./sound.js";
import { Tour } from "./tour.js";
import { Space } from "./space.js";

const $ = (id) => document.getElementById(id);
const stream = new Worker("stream.js", { type: "module" });
const say = (message) => stream.postMessage({ say: message });
const space = new Space({ canvas: $("space"), legend: $("space-legend"), low: $("space-low"), high: $("space-high"), missing: $("space-missing") });
const pictures = new Pictures(space);
const scene = new Scene(changed, () => bow?.release());
const slots = new Slots(scene, hold);
const mine = new Mine({ pictures, say: (message) => say({ ...message, revision }), scene, show: () => showSpectrum(true) });
const sound = new Sound(stream, heard);
const loop = new Loop(showLoop);
const recorder = new Recorder(48000);
const moves = new Map();
const sent = new Map(); // Scenes not answered yet, by revision.
const AMPLE = 1.5; // Seconds played per second with which gaps in the sound have other causes,
const BARELY = 0.95; // those taken for a system with gaps that are not ample, and
const SLOW = 1.05; // Seconds played per second below which the sound would have gaps,
const MARGIN = 1.1; // and the margin left to other work then.
const TOO_SLOW = 0.5; // Seconds played per second below which maps are computed only on request.
const PREPARES = 400; // Time after which a scene is shown as being prepared [ms].
const LOWEST = 20; // Lowest frequency of a note [Hz].
const LISTENING = "listening …"; // Until the first regime is found.
const PREPARING = "Preparing: computing meshes, modes and the initial state. Playing starts when they are ready.";
const COMPILING = "Compiling the simulation for this machine, once, which takes a minute or two. Playing starts by itself.";
const LONGEST = 60000; // Largest scenario accepted from the user [bytes].
const LONG = 5; // Time of drawing above which every other frame is skipped [ms].
const stats = { drawing: 0, revision: 0, played: 0, samples: 0, frames: 0, fps: 0, dropouts: 0, latency: null, latencies: [], connected: false, level: 0, peak: 0 };
let hello, controls, map, bow, gallery, challenges, tour, described, sources;
let turned = "null"; // The controls shown, if not those of two beams.
let played = null; // Seconds played per second, null for two beams, which any machine plays in real time.
let slowest = 1; // Seconds needed to play one second, 1 if it keeps up with the sound.
let revision = 0;
let begun = 0; // The revision at which the motion began.
let heardLast; // Source of the last part.
let mode = "live";
let skipped = false;
let badLink = false;

stream.onmessage = ({ data }) => {
  if (data.parts) came(data);
  else if (data.told) told(data.told);
  else if (data.file) save(data.file);
  else if (data.lost) lost(data);
  else if ("behind" in data) fallBehind(data.behind);
};

function told(message) {
  const answers = {
    compiling: () => prepares(COMPILING),
    hello: () => welcome(message),
    scene: () => shown(message),
    refused: () => refused(message),
    problem: () => {
      answered(revision);
      problem(message.problems);
    },
    stroke: () => stroke(message),
    theory: () => theory(message),
    now: () => {
      if (message.revision >= begun) goesOn(message);
      // A verdict on an earlier setting came too late.
      if (message.revision === revision) challenges.judge(message.verdict);
    },
    speed: () => follow(message.speed),
    fit: () => message.revision === revision && mine.took(message),
    "map row": () => map?.take(message),
    "map done": () => map?.done(message),
  };
  answers[message.type]?.();
}

async function welcome(message) {
  const first = !hello;
  hello = message;
  stats.connected = true;
  $("lost").hidden = true;
  if (first) {
    $("version").textContent = hello.version;
    $("kept").textContent = `the last ${hello.kept} s`;
    $("case").replaceChildren(...hello.presets.map(({ name, title }) => new Option(title, name)));
    gallery = new Gallery(hello.presets, choose);
    controls = new Controls($("controls"), hello, scene);
    bow = new Bow($("beams"), scene, controls, (words) => write("hand", words));
    tour = new Tour(hello.tour, scene, slots);
    challenges = new Challenges(hello.challenges, { scene, say, copied: copyLink, problem, note });
    map = new RegimeMap(scene, controls, hello.regimes, say);
    await readLink();
    challenges.read(scene.challenge, scene.hasSetting);
    // Undo does not go back to before the link.
    scene.past = [];
    // Before, they would open nothing.
    for (const name of ["instruments", "tour-begin", "challenges-open"]) $(name).disabled = false;
  } else challenges.again();
  if (sources) listenTo();
  say({ type: "repeat", on: $("repeat").checked });
  map.again();
  send();
}

function send() {
  map.leave();
  mine.forget();
  revision += 1;
  moves.set(revision, performance.now());
  if (moves.size > 200) moves.delete(moves.keys().next().value);
  sent.set(revision, structuredClone(scene.now));
  say({ type: "scene", revision, ...scene.now, case: scene.now.case || "squeal" });
  clearTimeout(send.timer);
  send.timer = setTimeout(() => prepares(PREPARING), PREPARES);
}

function prepares(words) {
  write("preparing", words);
  $("preparing").hidden = false;
}

function answered(number) {
  if (number < revision) return;
  clearTimeout(send.timer);
  $("preparing").hidden = true;
}

function changed() {
  challenges?.changed();
  note();
  send();
}

// Update the address bar and buttons to the scene.
function note() {
  clearTimeout(note.timer);
  note.timer = setTimeout(async () => history.replaceState(null, "", await scene.link()), 150);
  $("undo").disabled = !scene.canUndo;
  $("redo").disabled = !scene.canRedo;
  for (const name of ["A", "B"]) $(`slot-${name.toLowerCase()}`).setAttribute("aria-pressed", String(slots.heard === name));
}

function shown(message) {
  answered(message.revision);
  // Bodies already drawn are not sent again.
  if (message.drawn && !message.surfaces) for (const name of ["surfaces", "touches", "up"]) message[name] = described[name];
  described = message;
  stats.revision = message.revision;
  // The scene played in place of an unreadable link does not remove its message.
  $("problem").hidden = !badLink;
  badLink = false;
  if (!message.goes_on) {
    begun = message.revision;
    goesOn({ words: LISTENING });
    pictures.clear();
    write("theory", "");
    write("stroke", "");
    $("unrecorded").hidden = true;
    loop.forget();
    map.rest(message.speed !== null && message.speed < TOO_SLOW);
  }
  write("kept", `the last ${Number(message.seconds_kept.toPrecision(2))} s`);
  build(message.turned);
  controls.show(message.values, false, message.bounds);
  scene.places = message.places;
  offer(message);
  if (message.goes_on) follow(message.speed);
  else keepUp(message.speed);
  putBack(message);
  pictures.describe(message);
  mine.follow(message.fits, message.goes_on);
  map.follow(message.revision);
  bow.follow();
  showCase(message);
  const many = message.contact_count > 1 ? message.contact_count : 0;
  write("force-words", many ? `sum of ${many} contacts` : "");
  write("portrait-words", many ? `of the first of ${many} contacts` : "");
  showToml();
  write("numbers", `${message.modes} modes, ${message.steps} steps of ${short(1e6 * message.step)} µs per sample${message.longer ? ", twice as long as usual, to keep up with the sound" : ""}. `);
}

// Systems have their own controls.
function build(wanted) {
  const told = JSON.stringify(wanted);
  if (told === turned) return;
  turned = told;
  controls.build(wanted ?? hello);
}

// Sources of a system.
function offer({ sources: offered, source }) {
  if (JSON.stringify(offered) === JSON.stringify(sources)) return;
  sources = offered;
  $("source").replaceChildren(...Object.entries(sources).map(([name, { name: word, unit }]) => new Option(`${word} [${unit}]`, name)));
  $("source").value = source;
  showSource();
}

// The present motion as text, with its note if it is a tone.
function goesOn({ words, regime, frequency }) {
  const isTone = ["squeal", "stick-slip"].includes(regime) && frequency >= LOWEST;
  const { note, mode } = reading(isTone ? frequency : null, pictures.modes);
  mine.computed(isTone ? frequency : null);
  write("now", words);
  write("note", note);
  write("mode", mode);
}

function paceOf(speed) {
  if (speed === null || speed >= SLOW) return 1;
  const needed = MARGIN / speed;
  return needed < 10 ? Math.ceil(10 * needed) / 10 : Math.ceil(needed);
}

// The load of the machine varies: only a clearly different speed changes the pace.
function follow(speed) {
  const needed = paceOf(speed);
  if (needed > 1.1 * slowest || needed < 0.8 * slowest || isAmple(speed)) keepUp(speed);
  else played = speed;
}

function isAmple(speed) {
  return speed === null || speed >= AMPLE;
}

// The longest queue of sound is too short, or no longer: a system hardly faster than real time is too slow for sound.
function fallBehind(is) {
  if (is && slowest === 1 && !isAmple(played)) keepUp(BARELY);
  $("behind").hidden = !is || $("speed").value !== "1";
}

// Systems slower than real time are played as fast as possible, with a notice.
function keepUp(speed) {
  played = speed;
  const needed = paceOf(speed);
  const own = [...$("speed").options].find((one) => one.dataset.own);
  if (needed === slowest) return;
  const wasSlow = own?.selected;
  own?.remove();
  slowest = needed;
  if (needed === 1) loop.stop();
  if (needed > 1) {
    const option = new Option(`Slow, 1 : ${needed}, as fast as possible`, String(needed));
    option.dataset.own = "1";
    $("speed").append(option);
    option.selected = $("speed").value === "1" || wasSlow;
  } else if (wasSlow) $("speed").value = "1";
  $("pace").textContent = needed > 1 ? `Shown ${needed} times slower than real time, as fast as this machine can, and without sound.` : "";
  pace();
  showLoop();
}

// On request, slow systems are heard at true speed in a loop.
function showLoop() {
  $("loop").hidden = slowest === 1;
  $("loop").setAttribute("aria-pressed", String(Boolean(loop.source)));
  $("loop").textContent = loop.source ? "Stop the loop" : "Loop the last sound";
  write("loop-words", slowest > 1 && loop.source ? `The last ${short(1000 * loop.seconds)} ms, at true speed.` : "");
}

function showCase(message) {
  const own = scene.now.text !== null;
  const preset = hello.presets.find(({ name }) => name === scene.now.case);
  if (own && ![...$("case").options].some((one) => one.value === "")) $("case").append(new Option("Your own", ""));
  if (!own) [...$("case").options].filter((one) => one.value === "").forEach((one) => one.remove());
  $("case").value = own ? "" : scene.now.case;
  gallery.show($("case").value);
  write("case-words", own ? message.description || message.title : preset.description);
  $("case-words").title = $("case-words").textContent;
}

// Refused values return to those played; the reason is shown beside the control, or at the top if there is none.
function putBack({ revision: number, refused, kept }) {
  const asked = sent.get(number);
  for (const one of [...sent.keys()]) if (one <= number) sent.delete(one);
  const others = controls.refuse(refused);
  if (Object.keys(refused).length) challenges.refused();
  if (others.length) problem([...new Set(others.flatMap((key) => refused[key]))]);
  if (!kept || !asked) return;
  scene.putBack(asked, refused, kept);
  note();
}

// Write only changes, since writing causes a new layout.
function write(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}

// The text is long, so it is written only if visible.
function showToml() {
  if (!$("scenario").open || !described || document.activeElement === $("toml")) return;
  $("toml").value = `# ${scene.command()}\n${described.toml}`;
}

function refused(message) {
  answered(message.revision);
  putBack(message);
  if (!described) return;
  showCase(described);
  map.follow(described.revision);
}

function problem(lines) {
  $("problem").textContent = lines.join("\n");
  $("problem").hidden = false;
}

function stroke({ why, goes_on: goesOn }) {
  $("stroke").textContent = `Last stroke: ${why}.`;
  if (!goesOn) problem([`The stroke has ended: ${why}. Press New stroke, switch Repeat strokes on, or change a setting.`]);
}

function theory({ equilibrium, modes }) {
  pictures.modes = modes;
  const words = { sliding: "it slides steadily", held: "friction can hold the tip", "lifted off": "it lifts off", jammed: "it jams: it neither slides nor opens" };
  const growing = modes.map(({ frequency, growth_rate: growth }) => `${short(frequency)} Hz (growth ${short(growth)} 1/s)`).join(", ");
  $("theory").textContent = `Linear theory: ${words[equilibrium] ?? equilibrium}; ${growing ? `vibrations grow at ${growing}.` : "no vibration grows."}`;
}

function came({ parts: data, heard: listened }) {
  // Parts requested before a change of the source still have the old one.
  if (listened.name !== heardLast) pictures.spectrogram.clear();
  heardLast = listened.name;
  for (const part of parts(data)) {
    const [number, , , samples] = part.head;
    stats.samples += samples;
    stats.played = Math.max(stats.played, number);
    pictures.take(part);
    if (slowest > 1 && number >= described.revision) loop.take(part.values.subarray(0, samples));
    if (recorder.on && mode === "live" && $("speed").value === "1" && !recorder.take(part.values.subarray(0, samples), listened)) record();
    stats.level = pictures.level;
  }
}

function lost({ code, reason }) {
  stats.connected = false;
  $("lost").textContent = code === 4429 ? `No room: ${reason}. This page tries again every 5 s.` : code === 4403 ? `Refused: ${reason}.` : "Connection lost. This page reconnects when the server is back.";
  $("lost").hidden = false;
}

// Messages of the player: meters, drop-outs, and the first sound of a change.
function heard(data) {
  if ("revision" in data && moves.has(data.revision)) {
    stats.latency = performance.now() - moves.get(data.revision) + 1000 * sound.late;
    stats.latencies.push(stats.latency);
    for (const one of [...moves.keys()]) if (one <= data.revision) moves.delete(one);
    $("latency").textContent = `${Math.round(stats.latency)} ms`;
  }
  if (!("peak" in data)) return;
  if (data.dropouts > stats.dropouts) {
    stream.postMessage({ more: true });
    map?.hold();
  }
  stats.dropouts = data.dropouts;
  stats.peak = data.peak;
  $("dropouts").textContent = data.dropouts;
  const decibels = (value) => 20 * Math.log10(Math.max(value, 1e-6));
  $("level").style.width = `${Math.max(0, Math.min(100, 100 + (100 * decibels(data.peak)) / 60))}%`;
  $("limiter").style.width = `${Math.min(100, (-100 * decibels(data.reduction)) / 30)}%`;
  stats.reduction = data.reduction;
  if (silence() || !sources) return;
  const { full_scale: fullScale, unit } = sources[$("source").value];
  explainLevel(data.gain);
  const factor = data.gain * 10 ** (Number($("volume").value) / 20);
  $("level-out").textContent = `${Math.round(decibels(data.peak))} dB, limited by ${Math.round(-decibels(data.reduction))} dB`;
  $("scale-out").textContent = `full scale ${Number((fullScale / factor).toPrecision(2))} ${unit}`;
}

// Why there is no sound, an empty text if there is.
function silence() {
  if (!sound.on) return "muted";
  if (mode === "paused") return "silent while paused";
  return $("speed").value === "1" ? "" : "silent in slow motion";
}

function listenTo() {
  say({ type: "listen", source: $("source").value });
  showSource();
}

function showSource() {
  const name = $("source").value;
  const source = sources[name];
  stream.postMessage({ heard: { name, scale: 1 / source.full_scale, unit: source.unit } });
  loop.forget();
  pictures.source = name;
  pictures.spectra.clear();
  pictures.spectrogram.clear();
  $("spectrogram-words").textContent = `of the ${source.name.toLowerCase()}`;
  listen();
}

// Hold the pictures of the setting that stops; with null, none.
function hold(name) {
  pictures.held = name === null ? null : pictures.hold(name, $("source").value);
  pictures.playing = name === "A" ? "B" : "A";
  pictures.spectra.clear();
  $("said").textContent = pictures.held ? `Setting ${name} stays in the pictures of force and spectrum as a thin line` : "";
}

function showSpectrum(on) {
  $("as-spectrum").checked = pictures.asSpectrum = on;
  write("heard-title", on ? "Spectrum" : "Spectrogram");
  $("spectrogram").setAttribute("aria-label", on ? "Spectrum of the sound of the last moments, from 50 hertz to 12 kilohertz" : "Spectrogram of the sound, up to 12 kilohertz");
}

function listen() {
  if (!sources) return;
  explainLevel(1);
  $("volume-out").textContent = `${$("volume").value} dB`;
  sound.volume(Number($("volume").value), $("levelled").checked);
  loop.volume(Number($("volume").value));
}

// Whether the contact plays at true speed, also in the background.
function isLive() {
  return mode === "live" && $("speed").value === "1" && (sound.on || !document.hidden) && stats.connected;
}

function explainLevel(gain) {
  const source = sources[$("source").value];
  write("source-words", `${source.words} ${levelWords(source, $("levelled").checked, gain)}`);
}

function pace() {
  const slow = Number($("speed").value);
  pictures.pace(slow);
  // A muted page in the background rests.
  const rests = mode === "paused" || (document.hidden && !sound.on);
  recorder.hears(isLive(), performance.now() / 1000);
  stream.postMessage({ pace: { mode: rests ? "paused" : slow === 1 ? "live" : "slow", slow, own: Boolean($("speed").selectedOptions[0].dataset.own) } });
  if (mode === "paused" || slow !== 1) sound.flush();
  $("play").textContent = mode === "paused" ? "Play" : "Pause";
  $("step").disabled = mode !== "paused";
  $("level-out").textContent = silence();
  $("scale-out").textContent = "";
}

function draw() {
  requestAnimationFrame(draw);
  // If drawing is slow, every other frame is skipped to leave time for the sound.
  skipped = !skipped && stats.drawing > LONG;
  if (skipped) return;
  const began = performance.now();
  stats.frames += 1;
  pictures.draw();
  map?.draw(pictures.colours);
  stats.drawing += 0.05 * (performance.now() - began - stats.drawing);
}

// Begin to record, or end and offer the recording.
function record() {
  const begins = !recorder.on;
  $("record").setAttribute("aria-pressed", String(begins));
  $("record").textContent = begins ? "Stop" : "Record";
  const now = performance.now() / 1000;
  if (begins) {
    recorder.begin(now, isLive());
    $("unrecorded").hidden = true;
    write("gaps", "");
    return;
  }
  const bytes = recorder.end(now);
  $("recording").hidden = bytes === null;
  $("unrecorded").hidden = bytes !== null;
  if (bytes === null) {
    $("said").textContent = $("unrecorded").textContent;
    return;
  }
  URL.revokeObjectURL($("recording").href);
  const href = URL.createObjectURL(new Blob([bytes], { type: "audio/wav" }));
  write("gaps", recorder.missing ? `The recording lacks ${recorder.missing.toFixed(1)} s of sound that came too late.` : "");
  Object.assign($("recording"), { href, download: "stridula-recording.wav", textContent: `Save recording, ${recorder.seconds.toFixed(1)} s` });
  $("said").textContent = `recorded ${recorder.seconds.toFixed(1)} seconds`;
}

function save({ format, data }) {
  download(new Blob([data]), `stridula.${format}`);
}

function download(blob, name) {
  const anchor = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
}

// All pictures on one sheet.
function savePictures() {
  space.again();
  const canvases = [...document.querySelectorAll("canvas:not([hidden])")];
  const width = Math.max(...canvases.map((one) => one.width));
  const sheet = document.createElement("canvas");
  sheet.width = width + 40;
  sheet.height = canvases.reduce((sum, one) => sum + one.height + 50, 60);
  const paper = sheet.getContext("2d");
  paper.fillStyle = pictures.colours.panel;
  paper.fillRect(0, 0, sheet.width, sheet.height);
  paper.fillStyle = pictures.colours.ink;
  paper.font = "20px system-ui, sans-serif";
  paper.fillText(`stridula ${hello.version}: ${scene.command()}`, 20, 32);
  let y = 60;
  for (const one of canvases) {
    paper.fillText(one.closest("figure").querySelector("figcaption").innerText.replaceAll("\n", " "), 20, y + 18);
    paper.drawImage(one, 20, y + 28);
    y += one.height + 50;
  }
  sheet.toBlob((blob) => download(blob, "stridula.png"));
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  localStorage.setItem("theme", name);
  $("theme").textContent = name === "dark" ? "Light" : "Dark";
  pictures.theme();
}

async function readLink() {
  try {
    return await scene.read(location.hash);
  } catch {
    problem(["The link cannot be read: use a link made with Copy link."]);
    badLink = !described;
    return false;
  }
}

// Play a scenario of the user, unless it is longer than the server accepts.
async function playOwn(file, name) {
  if (file.size > LONGEST) problem([`scenario must be at most ${LONGEST / 1000} kB, got ${name} of ${Math.ceil(file.size / 1000)} kB`]);
  else scene.set({ case: "", text: await file.text(), overrides: {} });
}

function choose(name) {
  scene.set({ case: name, text: null, overrides: {} });
}

$("case").addEventListener("change", () => choose($("case").value));
$("undo").addEventListener("click", () => scene.undo());
$("redo").addEventListener("click", () => scene.redo());
$("link").addEventListener("click", copyLink);
$("share").hidden = !navigator.share;
$("share").addEventListener("click", async () => {
  history.replaceState(null, "", await scene.link());
  // Closing the dialog is not an error.
  await navigator.share({ title: document.title, text: $("now").textContent, url: location.href }).catch(() => {});
});
for (const name of ["A", "B"]) $(`slot-${name.toLowerCase()}`).addEventListener("click", () => slots.go(name));
$("record").addEventListener("click", record);
$("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
$("drawer").addEventListener("click", () => {
  const opens = $("drawer").getAttribute("aria-expanded") === "false";
  $("drawer").setAttribute("aria-expanded", String(opens));
  $("drawer").textContent = opens ? "Hide" : "Controls";
});
$("help").addEventListener("click", () => $("intro").showModal());
$("problem-close").addEventListener("click", () => ($("problem").hidden = true));
$("play").addEventListener("click", () => {
  mode = mode === "paused" ? "live" : "paused";
  pace();
});
$("step").addEventListener("click", () => stream.postMessage({ step: true }));
$("restart").addEventListener("click", () => {
  $("problem").hidden = true;
  say({ type: "restart" });
});
$("speed").addEventListener("change", pace);
$("repeat").addEventListener("change", () => {
  if ($("repeat").checked) $("problem").hidden = true;
  say({ type: "repeat", on: $("repeat").checked });
});
$("sound").addEventListener("click", async () => {
  const on = !sound.on;
  $("sound").setAttribute("aria-pressed", String(on));
  $("sound").textContent = on ? "Mute" : "Sound on";
  moves.clear();
  await sound.turn(on);
  pace();
});
$("loop").addEventListener("click", () => {
  if (loop.source) loop.stop();
  else if (loop.isLongEnough) loop.play(Number($("volume").value));
  else write("loop-words", "The sound computed so far is too short to play.");
});
$("source").addEventListener("change", listenTo);
$("as-spectrum").addEventListener("change", () => showSpectrum($("as-spectrum").checked));
$("volume").addEventListener("input", listen);
$("levelled").addEventListener("change", listen);
$("save-wav").addEventListener("click", () => say({ type: "save", format: "wav" }));
$("save-nc").addEventListener("click", () => say({ type: "save", format: "nc" }));
$("save-png").addEventListener("click", savePictures);
$("scenario").addEventListener("toggle", showToml);
$("toml-apply").addEventListener("click", () => playOwn(new Blob([$("toml").value]), "a text"));
$("toml-copy").addEventListener("click", () => copied($("toml").value, "scenario"));
$("toml-save").addEventListener("click", () => download(new Blob([$("toml").value]), "scenario.toml"));
$("toml-open").addEventListener("change", async () => {
  const [file] = $("toml-open").files;
  if (!file) return;
  await playOwn(file, file.name);
  $("toml-open").value = "";
});
window.addEventListener("hashchange", async () => {
  if (await readLink()) changed();
  challenges.read(scene.challenge, scene.hasSetting);
});
document.addEventListener("keydown", (event) => {
  const writing = event.target.matches("textarea, input[type=number], input[type=text]");
  const takesSpace = event.target.matches("button, select, summary, textarea, input:not([type=range])") || document.querySelector("dialog[open]");
  if ((event.ctrlKey || event.metaKey) && !writing && ["z", "y"].includes(event.key.toLowerCase())) {
    event.preventDefault();
    if (event.key.toLowerCase() === "y" || event.shiftKey) scene.redo();
    else scene.undo();
  } else if (event.key === "b" && !(event.ctrlKey || event.metaKey || event.altKey) && !writing && !event.target.matches("select") && !document.querySelector("dialog[open]")) {
    slots.go(slots.heard === "A" ? "B" : "A");
  } else if (event.key === " " && !takesSpace) {
    event.preventDefault();
    $("play").click();
  }
});
document.addEventListener("visibilitychange", pace);
// The tour and a challenge take the place of each other.
document.addEventListener("guided", ({ detail }) => (detail === "tour" ? challenges : tour).leave());
$("begin").addEventListener("click", () => sound.on || $("sound").click());
$("intro").addEventListener("close", () => localStorage.setItem("visited", "1"));

async function copyLink() {
  history.replaceState(null, "", await scene.link());
  await copied(location.href, "link");
}

async function copied(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    $("said").textContent = `${what} copied`;
  } catch {
    problem([`The browser does not let this page copy the ${what}: copy it from the ${what === "link" ? "address bar" : "field below"}.`]);
  }
}

// Texts beside the pictures change slowly enough to be read.
setInterval(() => {
  if (pictures.much === undefined) return;
  const shares = document.querySelectorAll("#shares .share");
  pictures.shares.forEach((share, i) => {
    const words = `${Math.round(100 * share)} %`;
    if (shares[i].textContent !== words) shares[i].textContent = words;
  });
  write("exaggeration", pictures.much ? `deflections ${pictures.much.toLocaleString("en")} times` : "");
}, 250);

setInterval(() => {
  stats.fps = stats.frames;
  stats.frames = 0;
  $("fps").textContent = stats.fps;
}, 1000);

window.stridula = { fallBehind, follow, keepUp, loop, space, stats, late: () => sound.late, shares: () => pictures.shares, scene, slots, now: () => described };
theme(localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
pace();
$("undo").disabled = $("redo").disabled = true;
if (!localStorage.getItem("visited")) $("intro").showModal();
const protocol = location.protocol === "https:" ? "wss" : "ws";
stream.postMessage({ connect: `${protocol}://${location.host}/socket` });
requestAnimationFrame(draw);

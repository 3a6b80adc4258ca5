// Sketches of instruments, a few strokes on a ground of 64 by 40, by the name of their case.
// `tip` is the rubbing part, `heard` the sound or the motion.
const CHALK = {
  like: "chalk on a board",
  paths: [["", "M5 5h54v26H5z M5 34h54"], ["tip", "M30 20l9-11 3.5 2.8-9 11z"], ["heard", "M12 24q4-3 8 0t8-1.5"]],
};
const CHATTER = {
  like: "chalk that chatters",
  paths: [["", "M5 5h54v26H5z M5 34h54"], ["tip", "M40 19l-9-11-3.5 2.8 9 11z"], ["heard", "M40 24h-2 M34 24h-2 M28 24h-2 M22 24h-2 M16 24h-2"]],
};
const HINGE = {
  like: "a door on its hinge",
  paths: [["", "M14 4v33 M18 6l26-2v34l-26-3z M39 20v3"], ["tip", "M12 10h6v5h-6z M12 26h6v5h-6z"], ["heard", "M8 9q-3 3 0 6 M8 25q-3 3 0 6"]],
};
const PRESSED_HINGE = {
  like: "a heavy door on its hinge",
  paths: [["", "M14 4v33 M18 6l30-2v34l-30-3z M23 11l20-1v10l-20 .5z M42 25v3"], ["tip", "M12 10h6v5h-6z M12 26h6v5h-6z"], ["heard", "M8 9q-3 3 0 6 M5 7q-5 5 0 10 M8 25q-3 3 0 6 M5 23q-5 5 0 10"]],
};
const PEN = {
  like: "a pen on paper",
  paths: [["", "M8 33l8-20h42l-8 20z"], ["tip", "M30 25l14-17 3.5 3-14 16-4.5 2z"], ["heard", "M16 27h12"]],
};
const PUSHED_PEN = {
  like: "a pen pushed ahead",
  paths: [["", "M8 33l8-20h42l-8 20z"], ["tip", "M31 26l-13-18-3.6 2.6 12.6 17.8 4.5 1.6z"], ["heard", "M36 27h13 M46 24.5l3 2.5-3 2.5"]],
};
const VIOLIN = {
  like: "a bow on a string",
  paths: [
    ["", "M6 20c0-7 8-9 12-6 2 1.5 5 1.5 7 0 5-3 12-1 12 6s-7 9-12 6c-2-1.5-5-1.5-7 0-4 3-12 1-12-6z M37 18.5h18v3H37 M55 17h5v6h-5z M11 20h44 M14 17v6"],
    ["tip", "M23 3l9 35 M26.5 2.5l8.5 34.5"],
  ],
};
const PLATE = {
  like: "a rod on a sheet of steel",
  paths: [["", "M4 29l12-11h44L48 29z M4 29v2.5h44V29 M48 31.5l12-11V18"], ["tip", "M29 23L41 5"], ["heard", "M22 24q2-3 5-3.5 M33 26.5q3.5-.5 5-3.5"]],
};
const PLATE_CHATTER = {
  like: "a rod hammering a sheet",
  paths: [["", "M4 29l12-11h44L48 29z M4 29v2.5h44V29 M48 31.5l12-11V18"], ["tip", "M34 20L22 4"], ["heard", "M34 23.5v1 M29 24h-1 M39 24h1 M31 22l-1-1 M37 22l1-1"]],
};
const BELT = {
  like: "a box on a conveyor",
  paths: [["", "M12 25h40a6 6 0 010 12H12a6 6 0 010-12z M12 31h.1 M52 31h.1 M3 6v16 M3 15l4 0 2-4 3 8 3-8 3 8 2-4h3"], ["tip", "M23 9h15v15H23z"], ["heard", "M43 20h12 M52 17.5l3 2.5-3 2.5"]],
};
const PULL = {
  like: "a box pulled by a spring",
  paths: [["", "M4 30h56 M8 30l-3 4 M18 30l-3 4 M28 30l-3 4 M38 30l-3 4 M48 30l-3 4 M58 30l-3 4 M24 22h4l2-4 3 8 3-8 3 8 2-4h4"], ["tip", "M8 14h16v16H8z"], ["heard", "M47 22h11 M55 19.5l3 2.5-3 2.5"]],
};
const BRAKE = {
  like: "a brake",
  paths: [["", "M30 4a16 16 0 100 32 16 16 0 100-32z M30 14a6 6 0 100 12 6 6 0 100-12z"], ["tip", "M40 9h9q5 11 0 22h-9q4-11 0-22z"], ["heard", "M8 13q-5 7 0 14"]],
};
const PAD = {
  like: "a pad on a turning disc",
  paths: [["", "M32 16c15 0 26 4.5 26 10s-11 10-26 10S6 31.5 6 26s11-10 26-10z M32 23.5c4 0 6 1 6 2.5s-2 2.5-6 2.5-6-1-6-2.5 2-2.5 6-2.5z"], ["tip", "M40 13l13 3v6l-13-3z M40 13l5-2.5 13 3-5 2.5 M58 13.5v6l-5 2.5 M49 4v7"], ["heard", "M13 25q2-4 9-5.5 M19.5 18l3 1.5-1.5 3"]],
};
const GLASS = {
  like: "a wet finger on a wine glass",
  paths: [["", "M19 10q-1 15 11 16 12-1 11-16 M19 10q11 4.5 22 0q-11-4.5-22 0 M30 26v10 M22 37h16"], ["tip", "M41 9l9-6q4-1 4 2.5l-11 7q-2.5 0-2-3.5z"], ["heard", "M14 8q-3 5-1 10 M10 7q-3 6-1 12"]],
};
const WHEEL = {
  like: "a railway wheel in a curve",
  paths: [["", "M30 3a15 15 0 100 30 15 15 0 100-30z M30 8a10 10 0 100 20 10 10 0 100-20z M30 16a2 2 0 100 4 2 2 0 100-4z M4 37h56"], ["tip", "M25 33h10v4H25z"], ["heard", "M50 11q5 7 0 14 M55 9q6 9 0 18"]],
};
const PIN = {
  like: "a pin on a turning disc",
  paths: [["", "M32 18c15 0 26 4 26 9s-11 9-26 9S6 32 6 27s11-9 26-9z M6 27v2c0 5 11 9 26 9s26-4 26-9v-2"], ["tip", "M41 25V5h5v20q-2.5 2-5 0z"], ["heard", "M14 27q2-4 9-5.5 M20.5 20l3 1.5-1.5 3"]],
};
const PLAIN = { like: "", paths: [["", "M6 30h52"], ["tip", "M30 29L43 8 M40 5h7v6h-7z"], ["heard", "M18 25q3-3 6 0"]] };

const KNOWN = {
  squeal: CHALK,
  judder: CHATTER,
  "weak-pressure": HINGE,
  "strong-pressure": PRESSED_HINGE,
  "stable-sliding": PEN,
  "axial-sliding": PUSHED_PEN,
  violin: VIOLIN,
  "squeal-on-plate": PLATE,
  "judder-on-plate": PLATE_CHATTER,
  belt: BELT,
  lugre: PULL,
  brake: BRAKE,
  "pad-on-disc": PAD,
  glass: GLASS,
  wheel: WHEEL,
  "pin-on-disc": PIN,
};

// The sketch of a case, a plain one for cases without.
export function sketchOf(name) {
  return Object.hasOwn(KNOWN, name) ? KNOWN[name] : PLAIN;
}

// Draw a sketch into an element.
export function draw(svg, name) {
  svg.replaceChildren(
    ...sketchOf(name).paths.map(([kind, d]) => {
      const path = document.createElementNS(svg.namespaceURI, "path");
      path.setAttribute("d", d);
      if (kind) path.setAttribute("class", kind);
      return path;
    }),
  );
}

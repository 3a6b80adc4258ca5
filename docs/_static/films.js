// Films of a page begin by themselves, unless less motion is wanted; each has its controls.
"use strict";
document.addEventListener("DOMContentLoaded", () => {
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  for (const film of document.querySelectorAll("video.film")) film.play().catch(() => {});
});

// The map of regimes: a cell for each setting, a point for each that sounds, larger where it is louder.
"use strict";
(function () {
  const QUIETEST = 30; // Level of the smallest point below the loudest [dB].

  class RegimeMap {
    constructor(canvas, chosen) {
      this.canvas = canvas;
      const choose = (event) => {
        if (event.type === "pointermove" && !event.buttons) return;
        const box = canvas.getBoundingClientRect();
        const column = Math.floor(((event.clientX - box.left) / box.width) * this.columns);
        const row = Math.floor((1 - (event.clientY - box.top) / box.height) * this.rows);
        const within = (value, count) => Math.min(Math.max(value, 0), count - 1);
        chosen(within(column, this.columns), within(row, this.rows));
      };
      canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        choose(event);
      });
      canvas.addEventListener("pointermove", choose);
    }

    draw(instrument, colours, [column, row]) {
      [this.columns, this.rows] = [instrument.x.values.length, instrument.y.values.length];
      const { width, height } = this.canvas, pen = this.canvas.getContext("2d");
      const [wide, high] = [width / this.columns, height / this.rows];
      const loudest = Math.max(...instrument.settings.map((one) => one.level ?? -Infinity));
      instrument.settings.forEach((setting, k) => {
        const [x, y] = [Math.floor(k / this.rows) * wide, height - ((k % this.rows) + 1) * high];
        pen.fillStyle = colours[setting.regime];
        pen.fillRect(x, y, wide + 1, high + 1);
        if (setting.level === null) return;
        const size = Math.max(1 - (loudest - setting.level) / QUIETEST, 0.2);
        pen.beginPath();
        pen.arc(x + wide / 2, y + high / 2, 0.3 * Math.min(wide, high) * size, 0, 2 * Math.PI);
        pen.fillStyle = "#ffffffcc";
        pen.fill();
      });
      const [x, y] = [column * wide, height - (row + 1) * high];
      pen.lineWidth = Math.max(width / 100, 3);
      pen.strokeStyle = "#000";
      pen.strokeRect(x + pen.lineWidth / 2, y + pen.lineWidth / 2, wide - pen.lineWidth, high - pen.lineWidth);
    }
  }

  window.stridulaDemonstration.RegimeMap = RegimeMap;
})();

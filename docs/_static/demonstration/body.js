// The bodies of a case in perspective, with the motion of a setting much exaggerated.
"use strict";
(function () {
  const SIZE = 0.85; // Of the picture.
  const AWAY = 5; // Distance of the eye, in extents.

  /** Return what turns places into the view of an eye at elevation and azimuth [degrees]. */
  function turning([elevation, azimuth]) {
    const e = (elevation * Math.PI) / 180, a = (azimuth * Math.PI) / 180;
    const [ce, se, ca, sa] = [Math.cos(e), Math.sin(e), Math.cos(a), Math.sin(a)];
    // To the right, up, and towards the eye.
    return [[ca, sa, 0], [-se * sa, se * ca, ce], [ce * sa, -ce * ca, se]];
  }

  class Body {
    constructor(canvas, body) {
      this.canvas = canvas;
      this.body = body;
      this.count = body.places.length / 3;
      this.view = turning(body.view);
      this.moved = new Float64Array(3 * this.count);
      this.onto = new Float64Array(3 * this.count);
      this.centre = [0, 1, 2].map((axis) => {
        let low = Infinity, high = -Infinity;
        for (let p = axis; p < body.places.length; p += 3) {
          low = Math.min(low, body.places[p]);
          high = Math.max(high, body.places[p]);
        }
        return ((low + high) / 2) * body.step;
      });
      const still = Float64Array.from(body.places, (value) => value * body.step);
      this.span = [0, 1].map((row) => {
        let most = body.extent / 10;
        for (let p = 0; p < this.count; p += 1) most = Math.max(most, Math.abs(this.#seen(still, p)[row]));
        return 2 * most;
      });
    }

    /** Return the place of a point to the right, up and towards the eye [m]. */
    #seen(places, p) {
      const at = [0, 1, 2].map((axis) => places[3 * p + axis] - this.centre[axis]);
      return this.view.map((row) => row[0] * at[0] + row[1] * at[1] + row[2] * at[2]);
    }

    /** Move all points to a phase of the cycle [rad] of a setting. */
    move(setting, phase) {
      const { places, shapes, step, grain, exaggeration } = this.body;
      for (let p = 0; p < places.length; p += 1) this.moved[p] = places[p] * step;
      shapes.forEach((shape, m) => {
        let amount = 0;
        for (const [k, ...parts] of setting.motion) {
          amount += parts[2 * m] * Math.cos(k * phase) - parts[2 * m + 1] * Math.sin(k * phase);
        }
        amount *= exaggeration * grain;
        for (let p = 0; p < places.length; p += 1) this.moved[p] += amount * shape[p];
      });
    }

    /** Return the phase at which the points are farthest from rest [rad]. */
    farthest(setting) {
      let [best, most] = [0, -1];
      for (let k = 0; k < 48; k += 1) {
        const phase = (2 * Math.PI * k) / 48;
        this.move(setting, phase);
        const far = this.moved.reduce((sum, value, p) => sum + (value - this.body.places[p] * this.body.step) ** 2, 0);
        if (far > most) [best, most] = [phase, far];
      }
      return best;
    }

    /** Draw a setting at a phase. */
    draw(setting, phase, colours) {
      const { width, height } = this.canvas, pen = this.canvas.getContext("2d");
      this.move(setting, phase);
      const { extent } = this.body;
      const size = Math.min((SIZE * width) / this.span[0], (SIZE * height) / this.span[1]);
      for (let p = 0; p < this.count; p += 1) {
        const [right, up, near] = this.#seen(this.moved, p);
        const wide = size / (1 - near / (AWAY * extent));
        this.onto.set([width / 2 + wide * right, height / 2 - wide * up, near], 3 * p);
      }
      pen.clearRect(0, 0, width, height);
      this.#faces(pen, colours);
      this.#lines(pen, colours);
      for (const p of setting.marks) {
        pen.beginPath();
        pen.arc(this.onto[3 * p], this.onto[3 * p + 1], Math.max(this.canvas.width / 80, 5), 0, 2 * Math.PI);
        pen.fillStyle = colours.mark;
        pen.fill();
        pen.strokeStyle = colours.ink;
        pen.lineWidth = 1.5;
        pen.stroke();
      }
    }

    #faces(pen, colours) {
      const order = this.body.faces.map((face) => {
        const far = face.reduce((sum, p) => sum + this.onto[3 * p + 2], 0) / face.length;
        return [far, face];
      });
      order.sort((a, b) => a[0] - b[0]);
      pen.lineWidth = Math.max(this.canvas.width / 1500, 0.5);
      for (const [, face] of order) {
        pen.beginPath();
        face.forEach((p, k) => pen[k ? "lineTo" : "moveTo"](this.onto[3 * p], this.onto[3 * p + 1]));
        pen.closePath();
        pen.fillStyle = colours.face(this.#facing(face), this.#outwards(face));
        pen.fill();
        pen.strokeStyle = colours.edge;
        pen.stroke();
      }
    }

    /** Return the cosine of the angle at which a face is seen. */
    #facing(face) {
      const [a, b, c] = [0, 1, 2].map((k) => this.moved.subarray(3 * face[k], 3 * face[k] + 3));
      const u = [0, 1, 2].map((k) => b[k] - a[k]), v = [0, 1, 2].map((k) => c[k] - a[k]);
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const towards = this.view[2];
      return (normal[0] * towards[0] + normal[1] * towards[1] + normal[2] * towards[2]) / (Math.hypot(...normal) || 1);
    }

    /** Return how far a face is from rest, of the farthest point of all settings. */
    #outwards(face) {
      const { places, step, reach } = this.body;
      let sum = 0;
      for (const p of face) {
        sum += Math.hypot(...[0, 1, 2].map((k) => this.moved[3 * p + k] - places[3 * p + k] * step));
      }
      return Math.min(sum / face.length / reach, 1);
    }

    #lines(pen, colours) {
      pen.strokeStyle = colours.line;
      pen.lineWidth = Math.max(this.canvas.width / 250, 2);
      pen.lineJoin = "round";
      for (const line of this.body.lines) {
        pen.beginPath();
        line.forEach((p, k) => pen[k ? "lineTo" : "moveTo"](this.onto[3 * p], this.onto[3 * p + 1]));
        pen.stroke();
      }
    }
  }

  window.stridulaDemonstration.Body = Body;
})();

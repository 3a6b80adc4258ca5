// The sound of a setting: its lines as one oscillator. Settings follow each other at equal power.
"use strict";
(function () {
  const FADE = 0.15; // Time of a change [s].
  const PEAK = 0.35; // Of the loudest setting of a case, of full scale.
  const POINTS = 64;

  /** Return the wave of a setting: samples are pressures in pascals. */
  function wave(context, setting) {
    const last = setting.lines.length ? setting.lines[setting.lines.length - 1][0] : 0;
    const real = new Float32Array(last + 1), imag = new Float32Array(last + 1);
    for (const [k, a, b] of setting.lines) {
      real[k] = a;
      imag[k] = -b;
    }
    return context.createPeriodicWave(real, imag, { disableNormalization: true });
  }

  /** Return the largest pressure of a setting that its lines can reach [Pa]. */
  function largest(setting) {
    return setting.lines.reduce((sum, [, a, b]) => sum + Math.hypot(a, b), 0);
  }

  /** Return the factor from pressure to full scale for all settings of a case. */
  function scale(settings) {
    return PEAK / Math.max(...settings.map(largest));
  }

  /** A setting that sounds, with a gain that changes at equal power. */
  class Voice {
    constructor(context, setting, factor) {
      this.context = context;
      this.factor = factor;
      this.gain = new GainNode(context, { gain: 0 });
      this.gain.connect(context.destination);
      this.oscillator = new OscillatorNode(context, { frequency: setting.base });
      this.oscillator.setPeriodicWave(wave(context, setting));
      this.oscillator.connect(this.gain);
      this.oscillator.start();
      this.change = { from: 0, to: 0, start: -1 };
    }

    /** Return the gain at a time, of 1. */
    at(time) {
      const { from, to, start } = this.change;
      const done = Math.min(Math.max((time - start) / FADE, 0), 1);
      return Math.sqrt(from ** 2 + (to ** 2 - from ** 2) * done);
    }

    turn(to) {
      const now = this.context.currentTime;
      this.change = { from: this.at(now), to, start: now };
      const curve = Float32Array.from({ length: POINTS }, (_, k) => {
        return this.factor * this.at(now + (FADE * k) / (POINTS - 1));
      });
      const value = this.gain.gain;
      value.cancelScheduledValues(now);
      value.setValueCurveAtTime(curve, now, FADE);
      if (to === 0) {
        this.oscillator.stop(now + FADE + 0.05);
        this.oscillator.onended = () => this.gain.disconnect();
      }
    }
  }

  /** Plays one setting at a time; silent until it is turned on by a click. */
  class Sound {
    constructor() {
      this.context = null;
      this.voice = null;
      this.on = false;
    }

    async turn(on) {
      this.on = on;
      if (on) {
        this.context ??= new AudioContext();
        await this.context.resume();
      } else {
        this.play(null);
      }
    }

    /** Play a setting with the scale of its case; null, or a setting without lines, is silent. */
    play(setting, factor) {
      if (this.voice) this.voice.turn(0);
      this.voice = null;
      if (!this.on || !setting || !setting.lines.length) return;
      this.voice = new Voice(this.context, setting, factor);
      this.voice.turn(1);
    }
  }

  /** Return the samples of a setting as they are played, in pascals. */
  async function rendered(setting, duration, rate) {
    const context = new OfflineAudioContext(1, Math.round(duration * rate), rate);
    const oscillator = new OscillatorNode(context, { frequency: setting.base });
    oscillator.setPeriodicWave(wave(context, setting));
    oscillator.connect(context.destination);
    oscillator.start();
    return Array.from((await context.startRendering()).getChannelData(0));
  }

  window.stridulaDemonstration = { Sound, Voice, scale, rendered, FADE };
})();

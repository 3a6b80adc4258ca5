// What one hears: the player in the thread of the sound, fed by the stream; muted at first.
export class Sound {
  constructor(stream, onTold) {
    Object.assign(this, { stream, onTold });
    this.on = false;
    this.decibels = 0;
    this.fullScale = 1;
  }

  // Why this page can have no sound, nothing if it can: browsers keep the thread of the sound to secure addresses.
  static missing(secure, { hostname, port }) {
    if (secure) return "";
    const local = `localhost:${port}`;
    return `Sound needs a secure address, which this is not: open ${local} on the machine that serves the page; elsewhere, run ssh -L ${port}:localhost:${port} ${hostname} and open ${local} there.`;
  }

  async turn(on) {
    if (on === this.on) return;
    this.on = on;
    if (!on) {
      this.stream.postMessage({ mute: true });
      this.player?.port.postMessage({ volume: 0, flush: true });
      await this.context?.suspend();
      return;
    }
    if (!this.context) await this.#begin();
    await this.context.resume();
    const { port1, port2 } = new MessageChannel();
    this.player.port.postMessage({ stream: port1, flush: true, needed: Math.round(0.06 * 48000) }, [port1]);
    this.stream.postMessage({ player: port2 }, [port2]);
    this.#tell();
  }

  async #begin() {
    this.context = new AudioContext({ sampleRate: 48000, latencyHint: "interactive" });
    await this.context.audioWorklet.addModule("player.js");
    this.player = new AudioWorkletNode(this.context, "player", { numberOfInputs: 0, outputChannelCount: [1] });
    this.player.port.onmessage = ({ data }) => this.onTold(data);
    this.player.connect(this.context.destination);
  }

  // Time from the queue of the player to the ear [s].
  get late() {
    return this.context ? (this.context.outputLatency || 0) + this.context.baseLatency + 0.003 : 0;
  }

  flush() {
    this.player?.port.postMessage({ flush: true });
  }

  volume(decibels, fullScale) {
    this.decibels = decibels;
    this.fullScale = fullScale;
    this.#tell();
  }

  #tell() {
    if (this.on) this.player?.port.postMessage({ volume: 10 ** (this.decibels / 20) / this.fullScale });
  }
}

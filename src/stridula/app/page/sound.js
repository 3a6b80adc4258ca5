// The sound: the player, fed by the stream; muted at first.
import { Voice } from "./player.js";

const QUANTUM = 128; // Samples per block of the audio thread.
const BLOCK = 1024; // Samples per block without an audio thread.

// A player in the audio thread; returns a function that sends it messages.
async function threaded(context, onTold) {
  await context.audioWorklet.addModule("player.js");
  const node = new AudioWorkletNode(context, "player", { numberOfInputs: 0, outputChannelCount: [1] });
  node.port.onmessage = ({ data }) => onTold(data);
  node.connect(context.destination);
  return (data, moved = []) => node.port.postMessage(data, moved);
}

// The same in the page itself: browsers allow the audio thread on secure addresses only.
function unthreaded(context, onTold) {
  const voice = new Voice(context.sampleRate, onTold);
  const node = context.createScriptProcessor(BLOCK, 0, 1);
  node.onaudioprocess = ({ outputBuffer }) => {
    const out = outputBuffer.getChannelData(0);
    for (let at = 0; at < BLOCK; at += QUANTUM) voice.fill(out.subarray(at, at + QUANTUM));
  };
  node.connect(context.destination);
  // A node without a reference may be collected, and falls silent.
  return Object.assign((data) => voice.told(data), { node });
}

export class Sound {
  constructor(stream, onTold) {
    Object.assign(this, { stream, onTold });
    this.on = false;
    this.decibels = 0;
    this.levelled = true;
  }

  async turn(on) {
    if (on === this.on) return;
    this.on = on;
    if (!on) {
      this.stream.postMessage({ mute: true });
      this.tell?.({ volume: 0, flush: true });
      await this.context?.suspend();
      return;
    }
    if (!this.context) await this.#begin();
    await this.context.resume();
    const { port1, port2 } = new MessageChannel();
    this.tell({ stream: port1, flush: true, needed: Math.round(0.06 * 48000) }, [port1]);
    this.stream.postMessage({ player: port2 }, [port2]);
    this.#tell();
  }

  async #begin() {
    this.context = new AudioContext({ sampleRate: 48000, latencyHint: "interactive" });
    const player = this.context.audioWorklet ? threaded : unthreaded;
    this.tell = await player(this.context, this.onTold);
  }

  // Time from the queue of the player to the ear [s].
  get late() {
    if (!this.context) return 0;
    const block = this.context.audioWorklet ? 0 : BLOCK / this.context.sampleRate;
    return block + (this.context.outputLatency || 0) + this.context.baseLatency + 0.003;
  }

  flush() {
    this.tell?.({ flush: true });
  }

  // Set the volume, in addition to the automatic level if it is on.
  volume(decibels, levelled) {
    Object.assign(this, { decibels, levelled });
    this.#tell();
  }

  #tell() {
    if (this.on) this.tell?.({ volume: 10 ** (this.decibels / 20), levelled: this.levelled });
  }
}

// A microphone beside the computed sound. Its samples stay in this page.
import { Agreed, pitchOf } from "./pitch.js";
import { hann, spectrum } from "./spectrum.js";

const SIZE = 8192; // Samples of a moment.
// Why there is no microphone, by the name of the browser's error.
const WHY = {
  NotAllowedError: "The browser does not let this page use the microphone: allow it beside the address, and press Microphone again.",
  SecurityError: "The browser does not let this page use the microphone: allow it beside the address, and press Microphone again.",
  NotFoundError: "No microphone was found: connect one, and press Microphone again.",
  NotReadableError: "The microphone cannot be read: another program may be using it.",
};
const INSECURE = "Browsers give the microphone to pages on this machine and over https only: open this page on the machine that computes.";
const PLAIN = { echoCancellation: false, noiseSuppression: false, autoGainControl: false };

export function reason(error) {
  return WHY[error?.name] ?? `The microphone cannot be used: ${error?.message || error}.`;
}

export class Microphone {
  constructor() {
    this.window = hann(SIZE);
    this.stream = null;
  }

  get on() {
    return this.stream !== null;
  }

  // Begin to listen; return why not, an empty text if it listens.
  async start(onEnd) {
    if (!navigator.mediaDevices?.getUserMedia) return INSECURE;
    try {
      this.stream = await navigator.mediaDevices.getUserMedia({ audio: PLAIN });
    } catch (error) {
      return reason(error);
    }
    this.context = new AudioContext();
    await this.context.resume();
    this.analyser = new AnalyserNode(this.context, { fftSize: SIZE });
    this.context.createMediaStreamSource(this.stream).connect(this.analyser);
    // A microphone that is unplugged ends.
    this.stream.getAudioTracks()[0].addEventListener("ended", onEnd);
    this.agreed = new Agreed();
    this.samples = new Float32Array(SIZE);
    return "";
  }

  stop() {
    this.stream?.getTracks().forEach((one) => one.stop());
    this.context?.close();
    this.stream = this.context = null;
  }

  // The spectrum of the last moment, its rate, and its pitch if it has one [Hz].
  read() {
    this.analyser.getFloatTimeDomainData(this.samples);
    const rate = this.context.sampleRate;
    const power = spectrum(this.samples, this.window);
    return { power, rate, frequency: this.agreed.after(pitchOf(power, rate)) };
  }
}

// The thread that speaks with the server: it asks for the next parts in time, hands sound to the player and pictures to
// the page, so that neither waits for the other.
import { parts } from "./parts.js";
import { Queue } from "./queue.js";

const PART = 480; // Samples of a part while live.
const FEWEST = 2; // Parts asked for at once.
const RATE = 48000;
const RETRY = 1000; // Time between attempts to come back [ms]
const ROOM = 5000; // and to find room.
const FULL = 4429; // Codes of a server that is full
const ELSEWHERE = 4403; // and of one whose page this is not.
const FRAME = 1000 / 60;
const LEAST = 12; // Samples of a part of what is shown as fast as it can be: of smaller ones the way takes longer than they do,
const PICTURES = 30; // and so many parts a second are enough.

let socket, player, url;
const queue = new Queue();
let behind = false;
let pace = { mode: "live", slow: 1, own: false };
let asked = 0; // Samples asked for that have not come.
let left = 0; // Samples the player has.
let heard = { scale: 1 }; // What is listened to, and what it is multiplied by for the player, now
let next = null; // and what is asked for from now on.
let clock = 0; // When time without a player was last counted [ms].
let owed = 0; // Samples owed to slow motion.
let file = null;
let hasScene = false;
let waiting = null; // A scene to be sent once the last one is answered.
let answered = true;

self.onmessage = ({ data }) => {
  if (data.connect) {
    url = data.connect;
    connect();
  } else if (data.player) {
    player = data.player;
    left = 0;
    player.onmessage = ({ data: told }) => {
      left = told.left;
      feed();
    };
  } else if (data.mute) {
    player = null;
    left = 0;
    clock = performance.now();
  } else if (data.pace) {
    pace = data.pace;
    left = player ? left : 0;
    clock = performance.now();
    owed = 0;
    feed();
  } else if (data.step) {
    pull(1, 1);
  } else if (data.more) {
    queue.drop(performance.now());
    judge();
  } else if (data.say) {
    if (data.say.type === "scene") scene(data.say);
    else say(data.say);
  } else if (data.heard) {
    next = data.heard;
    takeNext();
  }
};

function connect() {
  socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    asked = 0;
    answered = true;
    waiting = null;
    file = null;
    clock = performance.now();
  };
  socket.onmessage = ({ data }) => (typeof data === "string" ? told(JSON.parse(data)) : came(data));
  socket.onclose = ({ code, reason }) => {
    hasScene = false;
    postMessage({ lost: true, code, reason });
    if (code !== ELSEWHERE) setTimeout(connect, code === FULL ? ROOM : RETRY);
  };
}

function say(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

function scene(message) {
  if (!answered) {
    waiting = message;
    return;
  }
  answered = false;
  say(message);
}

function told(message) {
  if (message.type === "file") {
    file = message;
    return;
  }
  // A message that is refused as a whole may be the scene that is waited for.
  if (["scene", "refused", "problem"].includes(message.type)) {
    hasScene = hasScene || message.type === "scene";
    answered = true;
    if (waiting) {
      const next = waiting;
      waiting = null;
      scene(next);
    }
  }
  postMessage({ told: message });
  feed();
}

// What comes as bytes is a file that was announced, or the parts that were asked for.
function came(data) {
  if (file) {
    postMessage({ file: { ...file, data } }, [data]);
    file = null;
    return;
  }
  asked = 0;
  for (const { head, values } of parts(data)) {
    const [revision, , , samples] = head;
    if (!player || pace.mode !== "live") break;
    const sound = values.slice(0, samples).map((value) => heard.scale * value);
    player.postMessage({ sound, revision }, [sound.buffer]);
    left += samples;
  }
  const was = heard;
  takeNext();
  postMessage({ parts: data, heard: was }, [data]);
  feed();
}

// What was asked for before something else was listened to comes as it was.
function takeNext() {
  if (asked || next === null) return;
  heard = next;
  next = null;
}

// Ask for what is missing.
function feed() {
  if (!hasScene || asked || pace.mode === "paused") return;
  if (pace.mode === "live") {
    const now = performance.now();
    if (!player) left = Math.max(0, left - ((now - clock) * RATE) / 1000);
    clock = now;
    const missing = queue.length * RATE - left;
    if (missing >= FEWEST * PART) {
      const count = Math.min(10, Math.floor(missing / PART));
      if (!player) left += count * PART;
      pull(count, PART);
    }
    return;
  }
  const now = performance.now();
  const least = pace.own ? Math.max(LEAST, 4 * Math.floor(RATE / pace.slow / PICTURES / 4)) : 1;
  owed = Math.min(owed + ((now - clock) * RATE) / 1000 / pace.slow, Math.max(least, (4 * FRAME * RATE) / 1000 / pace.slow + 1));
  clock = now;
  if (owed < least) return;
  const samples = Math.min(PART, owed >= 4 ? 4 * Math.floor(owed / 4) : Math.floor(owed));
  if (samples >= 1) {
    owed -= samples;
    pull(1, samples);
  }
}

// Say where it changed whether the machine keeps up.
function judge() {
  const now = performance.now();
  queue.rest(now);
  if (queue.isBehind(now) === behind) return;
  behind = !behind;
  postMessage({ behind });
}

function pull(count, samples) {
  if (asked) return;
  asked = count * samples;
  say({ type: "pull", parts: count, samples });
}

setInterval(() => {
  if (!player || pace.mode !== "live") feed();
}, 10);

setInterval(judge, 1000);

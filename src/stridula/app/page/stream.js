// The thread that communicates with the server: it requests the next parts in time and passes sound to the player and
// pictures to the page, so that neither waits for the other.
import { Ahead, Ear, Lead } from "./ahead.js";
import { parts } from "./parts.js";
import { Queue } from "./queue.js";

const PART = 480; // Samples of a part while live.
const [FEWEST, MOST] = [2, 6]; // Parts per request: not many, since a change waits for them.
const RATE = 48000;
const RETRY = 1000; // Time between attempts to reconnect [ms],
const ROOM = 5000; // and to a full server.
const FULL = 4429; // Codes of a full server
const ELSEWHERE = 4403; // and of another server than that of this page.
const HEARD_SOON = ["scene", "listen", "restart"]; // Messages that change sound that is not heard yet.
const FRAME = 1000 / 60;
const LEAST = 12; // Least samples of a part of slow systems, since smaller parts take longer to send than to compute,
const PICTURES = 30; // and sufficient number of parts per second.

let socket, player, url;
const queue = new Queue();
let behind = false;
let pace = { mode: "live", slow: 1, own: false };
let asked = 0; // Samples requested but not received.
const ahead = new Ahead();
const lead = new Lead();
const ear = new Ear(RATE);
let begins = true; // Whether the next part is the first of a connection.
let heard = { scale: 1 }; // The present source, with its factor for the player,
let next = null; // and the source of later requests.
let clock = 0; // Last update of the time without a player [ms].
let due = 0; // Samples received before their time without a player.
let owed = 0; // Samples due in slow motion.
let file = null;
let hasScene = false;
let waiting = null; // The scene to send once the last one is answered.
let answered = true;

self.onmessage = ({ data }) => {
  if (data.connect) {
    url = data.connect;
    connect();
  } else if (data.player) {
    player = data.player;
    ahead.begin(ahead.end);
    ear.begin();
    player.onmessage = ({ data: told }) => {
      if (told.spare !== undefined) lead.arrived(told.spare / RATE);
      if (told.heard !== undefined) {
        ear.hears(told.heard, performance.now());
        show(told.heard);
      }
      feed();
    };
  } else if (data.mute) {
    player = null;
    show(ahead.end);
    clock = performance.now();
  } else if (data.pace) {
    pace = data.pace;
    if (!sounds()) show(ahead.end);
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
    ahead.begin(0);
    begins = true;
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
  if (!socket || socket.readyState !== WebSocket.OPEN) return;
  if (HEARD_SOON.includes(message.type)) message = { ...message, kept: kept() };
  socket.send(JSON.stringify(message));
}

// Number of samples that a change keeps: the server computes the others anew. None without sound.
function kept() {
  if (!sounds()) return null;
  const heard = Math.max(ahead.heard, ear.at(performance.now()));
  return Math.round(heard + Math.max(lead.length, queue.extra) * RATE);
}

function sounds() {
  return Boolean(player) && pace.mode === "live";
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
  if (message.type === "anew") {
    ahead.cut(message.samples);
    // The server sends the first parts at once.
    asked = Infinity;
    return;
  }
  // A message refused as a whole may be the scene in question.
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

// Bytes are an announced file, or requested parts.
function came(data) {
  if (file) {
    postMessage({ file: { ...file, data } }, [data]);
    file = null;
    return;
  }
  asked = 0;
  for (const { head, values, span } of parts(data)) {
    const [revision, seconds, , samples] = head;
    const end = Math.round(seconds * RATE);
    const at = end - samples;
    ahead.take({ at, end, data: data.slice(...span), heard }, sounds());
    if (!sounds()) continue;
    const sound = values.slice(0, samples).map((value) => heard.scale * value);
    player.postMessage({ sound, revision, at, begins }, [sound.buffer]);
    begins = false;
  }
  if (!sounds()) show(ahead.end);
  takeNext();
  feed();
}

// Show the parts that are heard.
function show(sample) {
  for (const { data, heard } of ahead.due(sample)) postMessage({ parts: data, heard }, [data]);
}

// Parts requested before a change of the source still have the old one.
function takeNext() {
  if (asked || next === null) return;
  heard = next;
  next = null;
}

// Request missing parts.
function feed() {
  if (!hasScene || asked || pace.mode === "paused") return;
  if (pace.mode === "live") {
    const now = performance.now();
    if (!player) due = Math.max(0, due - ((now - clock) * RATE) / 1000);
    clock = now;
    const left = player ? ahead.left : due;
    const missing = queue.length * RATE - left;
    if (missing >= FEWEST * PART) {
      const count = Math.min(MOST, Math.floor(missing / PART));
      if (!player) due += count * PART;
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

// Report changes of whether the machine keeps up.
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

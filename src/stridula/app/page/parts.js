// How parts lie in what the server sends: see `packed` on its side.
const HEAD = 64;

// Yield the head of each part and the values that follow it.
export function* parts(data) {
  for (let at = 0; at < data.byteLength; ) {
    const head = new Float64Array(data, at, 8);
    const [, , , samples, seen, nodes, points] = head;
    const count = samples + 5 * seen + 1 + 2 * nodes + points;
    yield { head, values: new Float32Array(data, at + HEAD, count) };
    at += HEAD + 4 * (count + (count % 2));
  }
}

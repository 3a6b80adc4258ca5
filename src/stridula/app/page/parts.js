// Format of the parts sent by the server: see `packed` on its side.
const HEAD = 72;

// Yield the head of each part, the values that follow it, and its first byte and end.
export function* parts(data) {
  for (let at = 0; at < data.byteLength; ) {
    const head = new Float64Array(data, at, 9);
    const [, , , samples, seen, nodes, points, contacts] = head;
    const count = samples + 5 * seen + 1 + 2 * nodes + points + 2 * contacts;
    const next = at + HEAD + 4 * (count + (count % 2));
    yield { head, values: new Float32Array(data, at + HEAD, count), span: [at, next] };
    at = next;
  }
}

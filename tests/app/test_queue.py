"""How much sound the page keeps ahead."""

from __future__ import annotations

import pytest

from .scripting import result_of

QUEUE = """import { Queue } from "./queue.js";
const queue = new Queue();
result = given.map(([what, now]) => {
  if (what === "drop") queue.drop(now);
  else queue.rest(now);
  return [queue.length, queue.isBehind(now)];
});"""


def test_the_queue_grows_during_drop_outs_and_shrinks_again(tmp_path):
    drops = [["drop", 1000.0 * k] for k in range(1, 31)]
    rests = [["rest", 30_000.0 + 10_000.0 * k] for k in range(1, 101)]
    found = result_of(tmp_path, QUEUE, [["rest", 0.0], *drops, *rests])
    lengths = [length for length, _ in found]
    assert lengths[:3] == pytest.approx([0.30, 0.32, 0.34])
    assert lengths[30] == max(lengths) == pytest.approx(0.44)
    calm = lengths[30:]
    assert calm == sorted(calm, reverse=True)
    assert lengths[31] == pytest.approx(0.44)
    assert lengths[32] == pytest.approx(0.435)
    assert lengths[-1] == pytest.approx(0.3)


def test_a_slow_machine_is_reported_until_it_keeps_up(tmp_path):
    drops = [["drop", 1000.0 * k] for k in range(1, 13)]
    behind = [said for _, said in result_of(tmp_path, QUEUE, [*drops, ["rest", 21_000.0], ["rest", 22_100.0]])]
    assert behind == [False] * 6 + [True] * 7 + [False]

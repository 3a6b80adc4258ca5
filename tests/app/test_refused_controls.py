"""Values of the page after some of them were refused."""

from __future__ import annotations

import pytest

from .scripting import result_of

PUT_BACK = """import { Scene } from "./scene.js";
const scene = new Scene(() => {});
scene.now = given.now;
scene.putBack(given.sent, given.refused, given.kept);
result = scene.now;"""


def scene(case: str = "squeal", text: str | None = None, **overrides: float) -> dict:
    return {"case": case, "text": text, "overrides": overrides}


@pytest.mark.parametrize(
    ("sent", "now", "refused", "kept", "wanted"),
    [
        (scene(length=0.2), scene(length=0.2), "length", scene(), scene()),
        (scene(length=0.2), scene(length=0.2), "length", scene(length=1.0), scene(length=1.0)),
        (scene(length=0.2), scene(length=0.2, angle=1.0), "length", scene(), scene(angle=1.0)),
        (scene(length=0.2), scene(length=0.3), "length", scene(), scene(length=0.3)),
        (scene(length=0.2), scene("judder"), "length", scene(), scene("judder")),
        (scene("nonsense", angle=1.0), scene("nonsense", angle=1.0), "", scene(), scene()),
        (scene("", "bad"), scene("", "bad"), "", scene("squeal", "good", angle=1.0), scene("", "good", angle=1.0)),
        (scene("", "bad"), scene("judder"), "", scene(), scene("judder")),
    ],
)
def test_refused_values_are_reset_unless_changed_again(tmp_path, sent, now, refused, kept, wanted):
    given = {"sent": sent, "now": now, "refused": {refused: ["no"]}, "kept": kept}
    assert result_of(tmp_path, PUT_BACK, given) == wanted

"""The main controls of each case: friction, force, and velocity or angle."""

from __future__ import annotations

import pytest

from stridula.app.playable import playable

from .scripting import result_of

MAIN = """import { mainKeys } from "./controls.js";
result = given.map(([numbers, values]) => mainKeys(numbers, values));"""


@pytest.mark.parametrize(
    ("case", "wanted"),
    [
        ("squeal", ["contact.friction.coefficient", "drives.0.transverse", "slider.angle"]),
        ("weak-pressure", ["contact.friction.coefficient", "drives.0.normal_load", "drives.0.velocity"]),
        ("judder-on-plate", ["contacts.0.friction.coefficient", "drives.0.axial", "bodies.slider.angle"]),
        ("violin", ["contacts.*.friction.static", "drives.*.x", "contacts.*.surface_velocity"]),
        ("belt", ["contacts.0.friction.static", "drives.0.y", "contacts.0.track.velocity"]),
        ("glass", ["contacts.0.friction.static", "drives.0.z", "bodies.glass.turning"]),
    ],
)
def test_friction_force_and_speed_come_first(tmp_path, case, wanted):
    turned = playable(case, None, {}).turned
    numbers = [vars(one) for one in turned.controls if one.key in turned.values]
    assert result_of(tmp_path, MAIN, [[numbers, turned.values]]) == [wanted]

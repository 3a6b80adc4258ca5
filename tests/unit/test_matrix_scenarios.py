"""Scenarios that name files of matrices of finite-element programs."""

from __future__ import annotations

import numpy as np
import pytest
from test_matrix_formats import CARDS, DECKS, MATRICES, PLACES, calculix, formats, written

import stridula as st

REST = """
[[contacts]]
tip = {body = "chain", point = "end"}
track = {kind = "rigid"}
inclination = "90 deg"
[simulation]
duration = "1 ms"
"""
SPACE = [(node, direction) for node in (7, 9) for direction in (1, 2, 3)]


def scenario(folder, keys, points):
    path = folder / "case.toml"
    path.write_text(f'[bodies.chain]\nkind = "reduced"\n{keys}\npoints = {{ {points} }}\n{REST}')
    return path


def files_in(folder):
    """Write all files into a separate folder, which the scenario does not name."""
    held = folder / "model"
    held.mkdir()
    contents = {f"{role}.matrix": formats.harwell_boeing(matrix) for role, matrix in MATRICES.items()}
    return written(calculix(held), contents | {"b.pch": CARDS, "deck.inp": DECKS["deck.inp"], "rows": calculix_rows()})


def calculix_rows():
    return formats.dof([(node, 1) for node in PLACES])


CALCULIX = 'mass = "model/job.mas"\nstiffness = "model/job.sti"'
GIVEN = {
    "one file": ('file = "model/job.sti"', "end = 9"),
    "two files": (CALCULIX, "end = 9"),
    "labels": (CALCULIX, "end = {x = [9, 1]}"),
    "place": (f'{CALCULIX}\nmesh = "model/deck.inp"', "end = [0.5, 0.02, 0.0]"),
    "cards": ('file = "model/b.pch"\ndamping = 0.0', "end = 9"),
    "labels elsewhere": (
        'mass = "model/mass.matrix"\nstiffness = "model/stiffness.matrix"\nlabels = "model/rows"',
        "end = 9",
    ),
}


@pytest.mark.parametrize(("keys", "points"), GIVEN.values(), ids=GIVEN)
def test_files_that_a_scenario_names(keys, points, tmp_path):
    files_in(tmp_path)
    case = st.load_scenario(scenario(tmp_path, keys, points))
    wanted = st.ReducedBody.read(tmp_path / "model" / "job.sti", points={"end": 9})
    np.testing.assert_allclose(case.system.slider.modes().frequency, wanted.modes().frequency, rtol=1e-6)
    assert st.load_scenario(case.simulate()).system == case.system


def test_a_translation_in_space(tmp_path):
    written(calculix(tmp_path), {"job.dof": formats.dof(SPACE)})
    case = st.load_scenario(scenario(tmp_path, 'file = "job.sti"\ntranslation = [1, 2, 3]', "end = 9"))
    np.testing.assert_array_equal(case.system.slider.translation, np.tile(np.eye(3), 2))


WRONG = {
    "no file": (f'{CALCULIX}\nmesh = "none.inp"', "end = 9", "cannot read '.*none.inp': no such file or directory"),
    "folder": (f'{CALCULIX}\nlabels = "model"', "end = 9", "bodies.chain.labels must be a file, got '.*model'"),
    "node": (
        CALCULIX,
        "end = 8",
        r"bodies.chain.points.end must name a node in the files that moves \(no node 8",
    ),
    "words": (
        CALCULIX,
        'end = "tip"',
        "bodies.chain.points must give the point end as rows .*, or as a node or a place",
    ),
    "written out": (
        'mass = [[1.0]]\nstiffness = [[1.0]]\nmesh = "model/deck.inp"',
        "end = {x = 0}",
        "bodies.chain.mesh must be left out where matrices are written out",
    ),
}


@pytest.mark.parametrize(("keys", "points", "message"), WRONG.values(), ids=WRONG)
def test_errors_are_named(keys, points, message, tmp_path):
    files_in(tmp_path)
    with pytest.raises((ValueError, OSError), match=message):
        st.load_scenario(scenario(tmp_path, keys, points))


def test_a_text_from_elsewhere_may_not_name_a_deck():
    from stridula.scenarios.read import tables_of_text

    text = f'[bodies.chain]\nkind = "reduced"\nmesh = "/etc/passwd"\n{REST}'
    with pytest.raises(ValueError, match="bodies must not name files in a text, got '/etc/passwd'"):
        tables_of_text(text, "a text")

"""Modes of CalculiX: its files against a body of the same mesh, binary against text, and places that are refused."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from test_calculix import CCX, MISSING, deck
from test_solid_files import STEEL

import stridula as st
from stridula.doubtful import DoubtfulValue

FILES = Path(__file__).parent / "modes"
TEXT, BINARY = FILES / "block.frd", FILES / "block_binary.frd"
# Relative error of numbers in format E12.5.
SIX_DIGITS = 5e-6


def block(cutoff=20e3, **options):
    return st.SolidBody.read(FILES / "block.inp", {"steel": STEEL}, cutoff=cutoff, **options)


@pytest.mark.parametrize("path", [TEXT, BINARY])
def test_modes_are_those_of_a_body_of_the_same_mesh(path):
    modes, solid = st.MeasuredModes.read(path, scale=1.0), block(fixed=["clamp"])
    agreement = st.mac(modes, solid)
    np.testing.assert_allclose(np.diag(agreement), 1.0, atol=1e-8)
    np.testing.assert_allclose(modes.frequency, agreement["computed_frequency"][:6], rtol=1e-6)
    for number in (5, 30, 69):
        expected = solid.trace(tuple(modes.places[number]))[:, :6]
        found = modes.normalised[number].real
        signs = np.sign((found * expected).sum(axis=0))
        np.testing.assert_allclose(found * signs, expected, atol=2.0 * SIX_DIGITS * np.abs(modes.shapes).max())


def test_binary_and_text_are_the_same():
    text, binary = (st.MeasuredModes.read(path, scale=1.0) for path in (TEXT, BINARY))
    assert text.points == binary.points
    np.testing.assert_array_equal(text.frequency, binary.frequency)
    np.testing.assert_array_equal(text.scaling, 1.0)
    np.testing.assert_allclose(text.places, binary.places, atol=SIX_DIGITS * 0.1)
    np.testing.assert_allclose(text.shapes, binary.shapes, rtol=2.0 * SIX_DIGITS, atol=1e-6)


def test_body_has_the_mobility_of_the_solid():
    """At resonances, the part in phase with the force; modes above those read add to the other one."""
    place, damping = (0.1, 0.04, 0.03), 0.01
    body = st.ModalBody.read(TEXT, points={"tip": place}, scale=1.0, damping=damping)
    solid = block(fixed=["clamp"], points={"tip": place}, damping=damping)
    frequency = np.array([2472.1, 3103.5])
    found, expected = (st.mobility(one.at("tip"), frequency=frequency, direction="z").values for one in (body, solid))
    np.testing.assert_allclose(found.real, expected.real, rtol=1e-4)
    assert body.at("tip").place == pytest.approx(place)


def test_scale_converts_lengths_and_masses():
    """In mm, N and s, the unit of mass is a tonne."""
    metres, millimetres = (st.MeasuredModes.read(TEXT, scale=scale) for scale in (1.0, 1e-3))
    np.testing.assert_allclose(millimetres.places, 1e-3 * metres.places)
    np.testing.assert_allclose(millimetres.scaling, 1e3)
    np.testing.assert_allclose(millimetres.normalised, metres.normalised / np.sqrt(1e3))
    with pytest.warns(DoubtfulValue, match=r"block.frd' has no units: taken as SI; pass scale=1.0 if it is"):
        st.MeasuredModes.read(TEXT)


@pytest.mark.parametrize("law", [0.01, [0.01, 0.02, 0.03, 0.01, 0.01, 0.02], st.Rayleigh(20.0, 1e-7)])
def test_damping_is_that_of_other_bodies(law):
    """Solid bodies compute theirs apart."""
    body = st.ModalBody.read(TEXT, scale=1.0, damping=law, points={"tip": "10"})
    solid = block(fixed=["clamp"], cutoff=13.5e3, damping=law)
    np.testing.assert_allclose(body.damping_rate, solid.modes().damping_rate[:6], rtol=1e-5)


@pytest.mark.skipif(CCX is None, reason=MISSING)
@pytest.mark.parametrize("output", ["*NODE FILE\nU\n*EL FILE\nS\n", "*NODE OUTPUT\nU\n*ELEMENT OUTPUT\nS\n"])
def test_free_blocks_keep_their_rigid_motions(tmp_path, output):
    """With stresses beside the shapes, as text and binary."""
    text = deck("hexahedron20", False, "").replace("\n6\n*END", f"\n12\n{output}*END")
    (tmp_path / "free.inp").write_text(text)
    done = subprocess.run([CCX, "free"], cwd=tmp_path, capture_output=True, text=True)
    assert "Job finished" in done.stdout, done.stdout[-2000:]
    modes = st.MeasuredModes.read(tmp_path / "free.frd", scale=1.0)
    assert (modes.frequency[:6] < 0.1).all()
    solid = st.SolidBody.read(tmp_path / "free.inp", {"steel": STEEL}, cutoff=32e3)
    agreement = st.mac(modes, solid).values
    assert agreement.shape[0] == 12
    np.testing.assert_allclose(np.diag(agreement[6:, 6:]), 1.0, atol=1e-6)
    # Rigid motions span the same space as translations and rotations.
    places = modes.places - modes.places.mean(axis=0)
    turned = [np.cross(axis, places) for axis in np.eye(3)]
    rigid = np.array([*(np.broadcast_to(axis, places.shape) for axis in np.eye(3)), *turned]).reshape(6, -1).T
    found = modes.shapes[:, :, :6].real.reshape(-1, 6)
    left = found - rigid @ np.linalg.lstsq(rigid, found, rcond=None)[0]
    assert np.abs(left).max() < 1e-4 * np.abs(found).max()


def changed(tmp_path, old, new, count=-1):
    path = tmp_path / "block.frd"
    text = TEXT.read_text()
    assert old in text
    path.write_text(text.replace(old, new, count))
    return path


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("    1C", "$COMMENT", r"line 1: must begin with 1C, as results of CalculiX, got '\$COMMENT'"),
        (" 9999\n", "", r"line 602: must have 9999 as last line, but the file ends: it is cut off"),
        ("2.45882E-01", "2.45882E-0x", r"line 123: needs finite numbers of 12 characters, got '2.45882E-0x'"),
        ("2.45882E-01", "        NaN", r"line 123: needs finite numbers of 12 characters, got 'NaN'"),
        (
            "2.412669E+08",
            "2.512669E+08",
            r"line 111: the mode has the frequency 2472.12 Hz, the modal mass 1 and the modal stiffness 2.51267e\+08",
        ),
        (" -4  DISP ", " -4  DISPI", r"has complex modes or those of a sector \(\*CYCLIC SYMMETRY\): modes of a whole"),
        ("1PHID                         -1", "1PHID                          2", r"or those of a sector"),
        ("                     2    1MODAL", "                     4    1MODAL", r"line 194: .* is there twice"),
        (
            "70                     2 ",
            "70                     0 ",
            r"must have modes.* results of other kinds \(static",
        ),
        ("          70                     2", "          71                     2", r"line 187: must have a node"),
        ("    2C                            70", "    2C                       7000000", r"more than the file can"),
        (" -1        30 2.", " -1        31 2.", r"moves node 31, which is not among the nodes"),
    ],
)
def test_lines_that_cannot_be_read_are_named(tmp_path, old, new, words):
    if "twice" in words:
        # The first mode again, with the frequency of the second.
        lines = TEXT.read_text().splitlines(keepends=True)
        (tmp_path / "block.frd").write_text("".join([*lines[:187], *lines[104:187], *lines[187:]]))
        path = tmp_path / "block.frd"
    elif "31" in words:
        lines = TEXT.read_text().splitlines(keepends=True)
        lines[118] = lines[118].replace("        30 ", "        31 ")
        path = tmp_path / "block.frd"
        path.write_text("".join(lines))
    else:
        path = changed(tmp_path, old, new)
    with pytest.raises(ValueError, match=rf"^cannot read .*block.frd': .*{words}"):
        st.MeasuredModes.read(path, scale=1.0)


def test_a_binary_file_that_is_cut_off_is_refused(tmp_path):
    whole = BINARY.read_bytes()
    for length in range(1000, len(whole) - 10, 997):
        (tmp_path / "a.frd").write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"^cannot read .*a.frd': .*cut off$"):
            st.MeasuredModes.read(tmp_path / "a.frd", scale=1.0)


def test_results_of_other_programs_say_what_to_export(tmp_path):
    with pytest.raises(ValueError, match=r"^path must be modes .* .frd, .op2, .rst: export the shapes of Abaqus as"):
        st.ModalBody.read(tmp_path / "a.odb")
    with pytest.raises(ValueError, match=r"^directions must be left out for .frd, .* got 'local'$"):
        st.ModalBody.read(TEXT, directions="local")
    with pytest.raises(ValueError, match=r"^quantity must be left out for results"):
        st.ModalBody.read(TEXT, quantity="displacement")
    with pytest.raises(ValueError, match=r"^points\['tip'\] must be within .* m of a node, got \(0.1, 0.04, 0.05\)"):
        st.ModalBody.read(TEXT, scale=1.0, points={"tip": (0.1, 0.04, 0.05)})
    with pytest.raises(ValueError, match=r"^scaling must be one of unit modal mass, got 'unit modal A'; did you"):
        st.ModalBody.read(TEXT, "unit modal A", scale=1.0)

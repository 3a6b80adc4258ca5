"""Layers between two faces: the springs of their points, and rigid faces in closed form."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

FREQUENCY = np.geomspace(100.0, 5e3, 7)


def faces(random, count):
    """Two rigid bodies on each other, with points opposite each other."""
    places = random.uniform(-0.05, 0.05, (count, 3)) * [1.0, 0.0, 1.0]
    names = {f"p{k}": tuple(place) for k, place in enumerate(places)}
    bodies = [st.RigidBody(0.5, inertia=[4e-4, 7e-4, 5e-4], points=names, name=name) for name in ("pad", "piston")]
    return bodies, places, [[body.at(name) for name in names] for body in bodies]


def measured(random):
    loss = random.uniform(0.05, 0.4)
    return (FREQUENCY / 1e3) ** (2.0 / np.pi * np.arctan(loss)), np.full(FREQUENCY.size, loss)


@pytest.mark.parametrize("seed", range(6))
def test_rigid_faces_feel_the_whole_layer(seed):
    """Sums over points: the stiffness of the whole, and about the middle that of the arms of the points."""
    random = np.random.default_rng(seed)
    count = int(random.integers(3, 9))
    _, places, (first, second) = faces(random, count)
    grows, loss = measured(random)
    areas = random.uniform(0.5, 2.0, count)
    across, along = random.uniform(1e7, 1e9), random.uniform(1e6, 1e8)
    stiffness = {"y": across * grows, "x": along * grows}
    springs = st.viscoelastic_layer(
        first, second, frequency=FREQUENCY, stiffness=stiffness, loss_factor=loss, area=areas
    )
    assert len(springs) == 2 * count
    for direction, whole in stiffness.items():
        own = [one for one in springs if one.direction == direction]
        found = sum(one.complex_stiffness(FREQUENCY) for one in own)
        np.testing.assert_allclose(found, whole * (1.0 + 1j * loss), rtol=0.03)
        # A turn about z moves points along y by their x.
        turned = sum(one.complex_stiffness(1e3) * place[0] ** 2 for one, place in zip(own, places, strict=True))
        expected = np.sum(areas * places[:, 0] ** 2) / areas.sum() * sum(one.complex_stiffness(1e3) for one in own)
        np.testing.assert_allclose(turned, expected, rtol=1e-9)


def test_two_masses_on_a_layer_decay_as_by_its_loss():
    """A mass on the ground: its frequency and its damping are those of the complex stiffness there."""
    mass = st.PointMass(0.8)
    grows, loss = measured(np.random.default_rng(3))
    springs = st.viscoelastic_layer([mass.centre], frequency=FREQUENCY, stiffness={"x": 3e7 * grows}, loss_factor=loss)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=1.0), friction=st.Coulomb(0.0))
    theory = st.sliding_stability(st.System(contact, [st.Force(mass.centre, y=-1.0)], springs))
    vibrates = int(np.argmax(theory.frequency.values))
    exponent = float(theory.growth_rate[vibrates]) + 2j * np.pi * float(theory.frequency[vibrates])
    stiffness = 0.8 * exponent**2
    own = springs[0].relaxation.stiffness(np.array([exponent / 1j]))[0]
    assert abs(stiffness + own) < 1e-6 * abs(own)


def test_loss_factors_by_direction_and_the_ground():
    mass = st.PointMass(1.0)
    springs = st.viscoelastic_layer(
        [mass.centre],
        frequency=[1e3],
        stiffness={"y": [1e8], "x": [1e7]},
        loss_factor={"y": [0.1], "x": [0.3]},
    )
    assert [(one.direction, one.second, one.loss_factor) for one in springs] == [
        ("y", None, (0.1,)),
        ("x", None, (0.3,)),
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"first": []}, "first must have one point or more, got none"),
        ({"second": []}, "second must have as many points as first, 1, got 0"),
        ({"stiffness": {}}, "stiffness must have tables by direction, x, y or z, got none"),
        ({"stiffness": {"r": [1.0]}}, "stiffness must have tables by direction, x, y or z, got r"),
        ({"loss_factor": {"x": [0.1]}}, "loss_factor must have the directions of stiffness, y, got x"),
        ({"area": [0.0]}, r"area\[0\] must be above 0"),
        ({"area": [1.0, 1.0]}, "area must have as many values as first has points, 1, got 2"),
        ({"stiffness": [1e8]}, "stiffness must be a Mapping"),
    ],
)
def test_wrong_layers_are_named(change, message):
    given = {"first": [st.PointMass(1.0).centre], "stiffness": {"y": [1e8]}, "loss_factor": [0.1]} | change
    with pytest.raises(ValueError, match=message):
        st.viscoelastic_layer(given.pop("first"), given.pop("second", None), frequency=[1e3], **given)

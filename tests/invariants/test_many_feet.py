"""Random blocks on one to eight feet, the laws mixed: some here, ten thousand by the program."""

from __future__ import annotations

import pytest

from .many_feet import LAWS, MOST, drawn, verdict

COUNT = 48


@pytest.mark.parametrize("first", range(MOST))
def test_random_feet_are_solved_and_obey_their_laws(first):
    for number in range(first, COUNT, MOST):
        assert verdict(0, number) == ("solved", set()), number


def test_all_laws_are_drawn():
    """Each of them, and up to eight feet."""
    drawn_laws = {type(foot.law).__name__ for number in range(COUNT) for foot in drawn(0, number).feet}
    # Two laws of rate and state are one class.
    assert len(drawn_laws) == len(LAWS) - 1
    assert {len(drawn(0, number).feet) for number in range(COUNT)} == set(range(1, MOST + 1))

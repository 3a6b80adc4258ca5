"""Classes implement protocols: the number of type checks in the package does not grow."""

from __future__ import annotations

import pytest

from .kinds import asked_kinds, counts

# Present numbers, to be lowered with the code; a new class implements a protocol instead of being checked.
MOST = 22


def test_type_checks_do_not_become_more():
    assert counts().total() <= MOST, counts().most_common(12)


@pytest.mark.parametrize(
    "source",
    [
        "from ..contact import Coulomb\nif isinstance(law, Coulomb): pass",
        "from ..contact import Coulomb\nif isinstance(law, (float, Coulomb)): pass",
        "from .. import contact\nif isinstance(law, contact.Coulomb): pass",
        "class Own: pass\ndef f(x): return isinstance(x, Own)",
        "from ..contact import Coulomb\nmatch law:\n    case Coulomb(): pass",
    ],
)
def test_the_count_finds_a_type_check(source):
    assert len(asked_kinds(source)) == 1


@pytest.mark.parametrize(
    "source",
    [
        "isinstance(x, (float, str))",
        "from numbers import Real\nisinstance(x, Real)",
        "from ..contact import Coulomb\nx == Coulomb",
    ],
)
def test_the_count_ignores_other_code(source):
    assert not asked_kinds(source)

"""Delta debugging finds planted sets, and none smaller is left in them."""

import itertools

import pytest

from ekfsim.why.trying.minimal import SpentError, minimal


@pytest.mark.parametrize("planted", list(itertools.combinations(range(9), 3)))
def test_a_planted_set_is_found(planted):
    assert minimal(range(9), lambda some: set(planted) <= set(some)) == planted


@pytest.mark.parametrize("one", range(7))
def test_a_single_one_is_found(one):
    assert minimal(range(7), lambda some: one in some) == (one,)


def test_none_of_what_is_left_can_be_spared():
    """Where two of different kinds are needed, whichever they are."""

    def holds(some):
        return any(n % 3 == 0 for n in some) and any(n % 5 == 1 for n in some)

    found = minimal(range(1, 16), holds)
    assert holds(found)
    assert not any(holds(tuple(m for m in found if m != n)) for n in found)


def test_where_the_budget_is_spent_the_smallest_so_far_is_left():
    asked = []

    def holds(some):
        if len(asked) == 2:
            raise SpentError
        asked.append(some)
        return {2, 3} <= set(some)

    found = minimal(range(8), holds)
    assert {2, 3} <= set(found)
    assert len(found) < 8

"""What is made ahead comes as it would without."""

from itertools import count, islice

import pytest

from ekfsim.fast.stretches import AHEAD, ahead


@pytest.mark.parametrize("n", [0, 1, AHEAD - 1, AHEAD, AHEAD + 1, 3 * AHEAD])
def test_it_is_the_same_in_the_same_order(n):
    assert list(ahead(iter(range(n)))) == list(range(n))


def test_no_more_is_made_than_that_many():
    made = []
    coming = ahead(made.append(k) or k for k in count())
    assert list(islice(coming, AHEAD + 1)) == list(range(AHEAD + 1))
    assert len(made) == 2 * AHEAD


@pytest.mark.parametrize("n", [0, 5, AHEAD, AHEAD + 5])
def test_what_fails_is_raised_after_what_did_not(n):
    def failing():
        yield from range(n)
        raise ValueError("no more")

    coming, seen = ahead(failing()), []
    with pytest.raises(ValueError, match="no more"):
        seen.extend(iter(coming))
    assert seen == list(range(n))
    assert next(coming, None) is None

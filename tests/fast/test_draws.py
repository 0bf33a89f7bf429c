"""Generators seeded together stand where NumPy's own do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ekfsim.errors import UsageError
from ekfsim.fast.one import draws as quick
from ekfsim.simulation.draws import Draws

WORDS = st.one_of(st.integers(0, 5), st.integers(0, 2**32 - 1), st.just(2**32 - 1))


@settings(max_examples=25)
@given(seed=WORDS, stretch=st.integers(0, 10**6 // quick.TOGETHER), block=WORDS)
def test_each_state_is_that_of_numpys_seed_sequence(seed, stretch, block):
    for i, words in enumerate(quick.seeds(seed, stretch, block), stretch * quick.TOGETHER):
        right = np.random.PCG64(np.random.SeedSequence([seed, i, block])).state["state"]
        assert quick.state_of(*words) == (right["state"], right["inc"])


@pytest.mark.parametrize("run", [0, 3, 1024, 2**42 + 5])
def test_draws_of_one_run_are_those_of_many(run):
    """Asked for in whatever order, with uniforms or without."""
    alone, among = Draws(5, np.asarray(run)), Draws(5, np.array([run + 1, run]))
    for i in (0, 15, 16, 300, 16, 255, 256, 4000):
        normals, uniforms = alone.normals_and_uniforms(i)
        right, right_uniforms = among.normals_and_uniforms(i)
        assert list(normals) == [float(each[1]) for each in right]
        assert list(uniforms) == [float(each[1]) for each in right_uniforms]
        assert list(alone.normals(i)) == list(normals)


def test_one_run_of_a_seed_of_two_words_is_refused():
    with pytest.raises(UsageError, match="seed 4294967296 is too large"):
        Draws(2**32, np.asarray(0))

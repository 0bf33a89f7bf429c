"""The quantile without SciPy equals SciPy's."""

import math

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ekfsim import twins
from ekfsim.fast import chi_square as quick
from ekfsim.filters.arithmetic.chi_square import quantile

DOFS = st.one_of(st.integers(1, 12), st.integers(1, quick.LARGEST))
PROBABILITIES = st.one_of(
    st.floats(1e-12, 1 - 1e-12), st.sampled_from([0.005, 0.5, 0.954, 0.99, 0.995, 0.999])
)


@given(probability=PROBABILITIES, dof=DOFS)
def test_it_equals_scipys(probability, dof):
    assert quick.quantile(probability, dof) == pytest.approx(
        quantile.text(probability, dof), rel=1e-12, abs=0
    )


@given(a=st.integers(1, 60).map(lambda k: k / 2), y=st.floats(1e-3, 80.0))
def test_the_tails_are_the_incomplete_gamma_functions(a, y):
    above, below, density = quick.tails(a, y)
    assert above == pytest.approx(float(mpmath.gammainc(a, y, regularized=True)), abs=1e-14)
    assert below == pytest.approx(float(mpmath.gammainc(a, 0, y, regularized=True)), abs=1e-14)
    assert density == pytest.approx(y**a * math.exp(-y) / math.gamma(a), rel=1e-12)


@pytest.mark.parametrize(
    ("probability", "dof"), [(0.0, 1), (1.0, 1), (math.nan, 1), (0.5, 0), (0.5, quick.LARGEST + 1)]
)
def test_what_it_does_not_suit_it_leaves_to_the_text(probability, dof):
    assert quick.quantile(probability, dof) is None
    with twins.taking("quick"):
        assert repr(quantile(probability, dof)) == repr(quantile.text(probability, dof))

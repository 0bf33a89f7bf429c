import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chi2

from ekfsim.filters.arithmetic.chi_square import band, quantile


@given(st.floats(0.001, 0.9999), st.integers(1, 2000))
def test_quantiles_are_those_of_scipy(p, dof):
    assert quantile(p, dof) == pytest.approx(chi2.ppf(p, dof), rel=1e-9)
    assert band(p, dof) == pytest.approx(chi2.interval(p, dof), rel=1e-7)


def test_no_freedom_has_no_room():
    assert quantile(0.999, 0) == 0
    assert band(0.99, 0) == (0, 0)

"""Chances without SciPy, held against SciPy."""

import numpy as np
import pytest
from scipy.special import bdtr, betainc, chdtrc

from ekfsim.diagnostics.chances import at_most_heads, below_beta, beyond_chi_square


def test_chances_of_chi_square():
    dof, value = np.meshgrid(np.arange(1, 41), [0.0, 1e-9, 0.1, 1, 3.84, 20, 150, 900.0])
    np.testing.assert_allclose(beyond_chi_square(dof, value), chdtrc(dof, value), rtol=1e-11)


def test_chances_of_beta_variables():
    a, b, x = np.meshgrid(
        [0.5, 1, 1.5, 3, 25, 250.5, 4000],
        [0.5, 1, 2, 7.5, 100],
        [0, 1e-6, 0.1, 0.5, 0.97, 1 - 1e-7, 1],
    )
    np.testing.assert_allclose(below_beta(a, b, x), betainc(a, b, x), rtol=2e-10, atol=1e-300)


@pytest.mark.parametrize("tosses", [1, 2, 9, 64, 1001, 20_000])
def test_chances_of_coins(tosses):
    heads = np.unique(np.linspace(0, tosses, 17).astype(int))
    wanted = bdtr(heads.astype(float), tosses, 0.5)
    np.testing.assert_allclose(
        at_most_heads(heads, np.full_like(heads, tosses)), wanted, rtol=1e-9, atol=1e-300
    )

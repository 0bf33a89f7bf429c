"""Chances of χ², of Beta variables and of coins, without SciPy, which takes longer to import than a
short run to calculate.
"""

import math
from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array, Integers

SETTLED = 1e-15  # of a continued fraction: a factor as close to 1 leaves rounding alone
TERMS = 10_000  # of it at most: some √max(a, b) do
TINY = 1e-300  # in place of 0, by which it would divide


def beyond_chi_square(dof: Integers, value: Array) -> Array:
    """The chance of a larger value of χ² : (…), for 1 or more degrees of freedom.

    Q(k + 2) = Q(k) + (x/2)^(k/2) e^(−x/2) / Γ(k/2 + 1), from Q(1) = erfc √(x/2), Q(2) = e^(−x/2)
    (Abramowitz & Stegun, 1964, 26.4.4 to 26.4.8).
    """
    return _each(_beyond_chi_square, dof, value)


def below_beta(a: Array, b: Array, x: Array) -> Array:
    """I_x(a, b), the chance that a Beta(a, b) variable is less than x in [0, 1] : (…)"""
    return _each(_below_beta, a, b, x)


def at_most_heads(most: Integers, tosses: Integers) -> Array:
    """The chance of at most so many heads among as many tosses of a fair coin : (…)

    Σ C(n, i) / 2ⁿ up to k is I_½(n − k, k + 1) (26.5.24).
    """
    return _each(_at_most_heads, most, tosses)


def _each(chance: Callable[..., float], *numbers: Array | Integers) -> Array:
    return np.asarray(np.vectorize(chance, otypes=[float])(*numbers))


def _beyond_chi_square(dof: float, value: float) -> float:
    half, k = value / 2, int(dof)
    if half <= 0:
        return 1.0
    at = 1 if k % 2 else 2
    chance = math.erfc(math.sqrt(half)) if at == 1 else math.exp(-half)
    for j in range(at, k, 2):
        chance += math.exp(j / 2 * math.log(half) - half - math.lgamma(j / 2 + 1))
    return chance


def _at_most_heads(most: float, tosses: float) -> float:
    return 1.0 if most >= tosses else _below_beta(tosses - most, most + 1, 0.5)


def _below_beta(a: float, b: float, x: float) -> float:
    if x <= 0 or x >= 1:
        return float(x >= 1)
    if x > (a + 1) / (a + b + 2):  # there the fraction of the other tail settles sooner
        return 1 - _below_beta(b, a, 1 - x)
    ln_B = math.lgamma(a) + math.lgamma(b) - math.lgamma(a + b)
    return math.exp(a * math.log(x) + b * math.log1p(-x) - ln_B) / a / _fraction(a, b, x)


def _fraction(a: float, b: float, x: float) -> float:
    """1 + d₁/(1 + d₂/(1 + …)), by the products of Lentz          26.5.8

    d₂ₘ = m (b − m) x / ((a + 2m − 1)(a + 2m)),
    d₂ₘ₊₁ = −(a + m)(a + b + m) x / ((a + 2m)(a + 2m + 1))
    """
    value = above = 1.0
    below = 0.0
    for n in range(1, TERMS):
        m, at = n // 2, a + n
        d = -(a + m) * (a + b + m) if n % 2 else m * (b - m)
        d *= x / ((at - 1) * at)
        below = 1 / (1 + d * below or TINY)
        above = 1 + d / above or TINY
        value *= above * below
        if abs(above * below - 1) < SETTLED:
            break
    return value

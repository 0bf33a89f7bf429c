"""Sensors on a bench: noisy readings of what is known, from a generator that is handed in."""

import math
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.geometry import Array
from ekfsim.models.protocols import Sensor
from ekfsim.systems.echo import Pair, height

if TYPE_CHECKING:
    from numpy.random import Generator


def gaussian(mean: Array, covariance: Array, generator: "Generator") -> Array:
    """A draw of N(mean, covariance) for each mean : (…, n). covariance : (n, n) or (…, n, n)"""
    drawn: Array = mean + np.matvec(square_root(covariance), generator.standard_normal(mean.shape))
    return drawn


def readings(sensor: Sensor, x: Array, generator: "Generator") -> Array:
    """z = h(x) + noise of covariance R for each state x (…, n) : (…, k)

    nan where the sensor meets nothing.
    """
    h, _, R = sensor.linearize(x)
    return gaussian(h, np.nan_to_num(R), generator)


def echoes(pair: Pair, n: int, generator: "Generator") -> Array:
    """n echoes of 1 V height from anywhere in the pair's range : (n, 4) V, s, s, 1

    T and α as the pair's vary.
    """
    τ = pair.flight(generator.uniform(pair.nearest, pair.farthest, n))
    T, α = (
        typical * (1 + pair.spread * generator.standard_normal(n))
        for typical in (pair.rise, pair.power)
    )
    return np.stack([1 / height(1.0, α), τ, T, α], axis=-1)


def sigma_of(snr: float) -> float:
    """σ of the noise in V, where a carrier of 1 V height stands `snr` dB above it.

    SNR = 10 log₁₀ (½ V²/σ²)

    >>> round(sigma_of(20.0), 4)
    0.0707
    """
    return math.sqrt(0.5) * 10 ** (-snr / 20)


def heard(pair: Pair, echo: Array, sigma: float, generator: "Generator") -> Array:
    """What the receiver samples of echoes (…, 4), with white noise of σ V : (…, k) V"""
    clean = pair.received(echo)
    return clean + sigma * generator.standard_normal(clean.shape)

"""What the filters are tried on: linear problems of any size, a classroom, and a mower among
markers."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from numerics import covariance

from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.protocol import Beginning
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.protocols import Quantity
from ekfsim.models.sensors.landmarks import RangeBearing
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls

ROOM = Walls.of({"boundary": np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])})


@dataclass
class Linear:
    """A linear motion and a linear sensor of any size, with a heading among the readings where
    `angles` says so."""

    A: np.ndarray
    B: np.ndarray
    input_noise: np.ndarray
    process_noise: np.ndarray
    C: np.ndarray
    noise: np.ndarray
    angles: tuple = field(default=())

    @property
    def inputs(self):
        return tuple(Quantity(f"u{i}", "m") for i in range(self.B.shape[-1]))

    @property
    def outputs(self):
        return tuple(
            Quantity(f"z{i}", "rad" if i in self.angles else "m") for i in range(len(self.C))
        )

    def f(self, x, u):
        return np.matvec(self.A, x) + np.matvec(self.B, u)

    def F(self, x, u):
        return np.broadcast_to(self.A, (*x.shape[:-1], *self.A.shape))

    def G(self, x, u):
        return np.broadcast_to(self.B, (*x.shape[:-1], *self.B.shape))

    def M(self, u):
        return self.input_noise

    def Q(self, u):
        return self.process_noise

    def linearize(self, x, *u):
        if u:
            return self.f(x, *u), self.F(x, *u), self.G(x, *u), self.M(*u), self.Q(*u)
        return self.h(x), self.H(x), self.R(x)

    def h(self, x):
        return np.matvec(self.C, x)

    def H(self, x):
        return np.broadcast_to(self.C, (*x.shape[:-1], *self.C.shape))

    def R(self, x):
        return self.noise

    def residual(self, z, h):
        ν = z - h
        for i in self.angles:
            ν[..., i] = np.angle(np.exp(1j * ν[..., i]))
        return ν


class Bent:
    """A motion and a sensor without a straight line in them, of any size."""

    outputs = (Quantity("z0", "m"), Quantity("z1", "m"))

    def __init__(self, random, n):
        self.line = problem(random, n, 2, 2)

    def f(self, x, u):
        return np.sin(self.line.f(x, u)) + 0.1 * self.line.f(x, u) ** 2

    def linearize(self, x, *u):
        if u:
            return self.f(x, *u), None, self.line.B, self.line.input_noise, self.line.process_noise
        return self.h(x), None, self.line.noise

    def h(self, x):
        z = self.line.h(x)
        return np.cos(z) + z

    def residual(self, z, h):
        return z - h


def problem(random, n=3, m=2, k=1):
    return Linear(
        random.normal(size=(n, n)), random.normal(size=(n, m)), covariance(random, m),
        covariance(random, n),
        random.normal(size=(k, n)), covariance(random, k) + 0.1 * np.eye(k),
    )  # fmt: skip


def theirs(kind, model, x, P):
    """filterpy's filter of the same problem."""
    n, m, k = len(model.A), model.B.shape[1], len(model.C)
    other = kind(dim_x=n, dim_z=k, dim_u=m)
    other.x, other.P, other.F, other.B, other.R, other.H = (
        x.copy(),
        P.copy(),
        model.A,
        model.B,
        model.noise,
        model.C,
    )
    other.Q = model.B @ model.input_noise @ model.B.T + model.process_noise
    return other


def close(a, b):
    return a == pytest.approx(b, rel=1e-12, abs=1e-12 * max(1.0, np.abs(b).max()))


def begun(name, first, gate=None, headings=(2,), runs=(0,), seed=0):
    """A filter as a run begins it, whose plan is to stay there. The generator of a run depends on
    its number alone."""
    generators = lambda: [np.random.default_rng([seed, run]) for run in runs]  # noqa: E731
    plan = lambda: first.mean[None]  # noqa: E731
    return FILTERS[name].begin(
        Beginning(first, headings, gate, generators, nominal=plan, anywhere=anywhere)
    )


def anywhere(generator, number):
    """Poses from all over a room of 10 m by 8 m."""
    return generator.uniform((0, 0, -np.pi), (10, 8, np.pi), (number, 3))


def classroom(random, axes=()):
    """A belief in a room, a beam and a motion."""
    x = random.uniform((1, 1, -3), (9, 7, 3), (*axes, 3))
    P = 0.01 * covariance(random, *axes, 3) + 1e-4 * np.eye(3)
    return Gaussian(x, P), Laser(ROOM, random.uniform(-3, 3), 0.02), MoveTurn(0.05, 0.1)


def landmark(x=2.0, y=3.0, range_sigma=0.1, bearing_sigma=0.02):
    return RangeBearing(x, y, range_sigma, bearing_sigma)

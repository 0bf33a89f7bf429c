"""A motion whose input is measured wrongly all the while, by what the state holds beside the rest.

A gyro's bias and a wheel's scale are found as the pose is: they are entries of the state.
"""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.protocols import Motion, Quantity


def by_input(motion: Motion, x: Array, u: Array) -> Array:
    """∂f/∂u : (…, n, m), which G is in all but one: the mower's wheels drive, and its gyro turns.

    Its G tells how the noise of its wheels is taken to turn it (document 000, eq. 22).
    """
    G = motion.G(x, u)
    if type(motion) is GyroWheels:
        middle = x[..., 2] + u[..., 2] * u[..., 3] / 2
        ahead = np.stack([np.cos(middle), np.sin(middle), np.zeros_like(middle)], axis=-1) / 2
        return np.concatenate([ahead[..., None], ahead[..., None], G[..., 2:]], axis=-1)
    return G


@dataclass(frozen=True, slots=True)
class Misread:
    """One way in which entries of the input are measured wrongly."""

    entries: tuple[int, ...]  # of u
    # measured = (1 + e)·true; else measured = true + e
    is_scale: bool
    over: int | None = None  # the entry of u, a time, over which a rate adds up: true + e·dt
    density: float = 0.0  # of its random walk, per √s: 0 where it never changes


@dataclass(frozen=True, slots=True)
class Biased(Motion):
    """x = (x of `motion`, e₁, e₂, …), u as it is measured.

        f(x, u) = (f of `motion` at x and the right input, e₁, e₂, …)

    The right input is (u − biases)/(1 + scale errors).
    """

    motion: Motion
    n: int  # entries of its state
    errors: tuple[Misread, ...]
    dt: int | None  # the entry of u that tells the time of an input; None where none does
    tick: float  # s, of an input that does not tell its time

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Those of the motion."""
        return self.motion.inputs

    def f(self, x: Array, u: Array) -> Array:
        """The next state, its errors as they were : (…, n)"""
        own, errors = self._parts(x)
        moved = self.motion.f(own, self._right(errors, u))
        return np.concatenate(
            [moved, np.broadcast_to(errors, (*moved.shape[:-1], errors.shape[-1]))], axis=-1
        )

    def F(self, x: Array, u: Array) -> Array:
        """[F of `motion`, ∂f/∂u · ∂(right input)/∂e; 0, I] : (…, n, n)"""
        own, errors = self._parts(x)
        right = self._right(errors, u)
        by_own, by_u = self.motion.F(own, right), by_input(self.motion, own, right)
        axes = np.broadcast_shapes(by_own.shape[:-2], by_u.shape[:-2], right.shape[:-1])
        F = np.broadcast_to(np.eye(x.shape[-1]), (*axes, x.shape[-1], x.shape[-1])).copy()
        F[..., : self.n, : self.n] = by_own
        F[..., : self.n, self.n :] = by_u @ self._by_errors(errors, right, u)
        return F

    def G(self, x: Array, u: Array) -> Array:
        """[G of `motion` · ∂(right input)/∂u; 0] : (…, n, m)"""
        own, errors = self._parts(x)
        G = self.motion.G(own, self._right(errors, u)) @ self._by_input(errors, u.shape[-1])
        return np.concatenate(
            [G, np.zeros((*G.shape[:-2], len(self.errors), u.shape[-1]))], axis=-2
        )

    def M(self, u: Array) -> Array:
        """That of the motion : (…, m, m)"""
        return self.motion.M(u)

    def Q(self, u: Array) -> Array:
        """Q of the motion, and density² dt of each error : (…, n, n)"""
        dt = np.full(u.shape[:-1], self.tick) if self.dt is None else u[..., self.dt]
        n, k = self.n, len(self.errors)
        Q = np.zeros((*u.shape[:-1], n + k, n + k))
        Q[..., :n, :n] = self.motion.Q(u)
        for i, one in enumerate(self.errors, n):
            Q[..., i, i] = one.density**2 * dt
        return Q

    def _parts(self, x: Array) -> tuple[Array, Array]:
        """The state of the motion, and the errors."""
        return x[..., : self.n], x[..., self.n :]

    def _right(self, errors: Array, u: Array) -> Array:
        """The input without the errors : (…, m)"""
        axes = np.broadcast_shapes(errors.shape[:-1], u.shape[:-1])
        right = np.broadcast_to(u, (*axes, u.shape[-1])).copy()
        for i, one in enumerate(self.errors):
            if not one.is_scale:
                added = errors[..., i] * (1.0 if one.over is None else u[..., one.over])
                for entry in one.entries:
                    right[..., entry] -= added
        return right / self._scales(errors, u.shape[-1])

    def _scales(self, errors: Array, m: int) -> Array:
        """By what each entry of the input is measured too large : (…, m)"""
        scales = np.ones((*errors.shape[:-1], m))
        for i, one in enumerate(self.errors):
            if one.is_scale:
                scales[..., one.entries] *= 1 + errors[..., i, None]
        return scales

    def _by_errors(self, errors: Array, right: Array, u: Array) -> Array:
        """∂(right input)/∂e : (…, m, k)"""
        scales = self._scales(errors, u.shape[-1])
        J = np.zeros((*right.shape, len(self.errors)))
        for i, one in enumerate(self.errors):
            for entry in one.entries:
                if one.is_scale:
                    J[..., entry, i] = -right[..., entry] / (1 + errors[..., i])
                else:
                    added = 1.0 if one.over is None else u[..., one.over]
                    J[..., entry, i] = -added / scales[..., entry]
        return J

    def _by_input(self, errors: Array, m: int) -> Array:
        """∂(right input)/∂u : (…, m, m)"""
        scales = self._scales(errors, m)
        J = np.eye(m) / scales[..., None]
        for i, one in enumerate(self.errors):
            if one.over is not None:
                for entry in one.entries:
                    J[..., entry, one.over] -= errors[..., i] / scales[..., entry]
        return J

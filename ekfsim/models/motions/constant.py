"""What does not change but for its noise: parameters, estimated as if they were a state."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Motion, Quantity


@dataclass(frozen=True, slots=True, eq=False)
class Constant(Motion):
    """x = any n numbers; u : (…, 0) is empty."""

    process: Array | float = 0.0  # (n, n)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """None."""
        return ()

    def f(self, x: Array, u: Array) -> Array:
        """x = x"""
        return np.broadcast_to(
            x, (*np.broadcast_shapes(x.shape[:-1], u.shape[:-1]), x.shape[-1])
        ).copy()

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x = I : (…, n, n)"""
        n = x.shape[-1]
        return np.broadcast_to(np.eye(n), (*np.broadcast_shapes(x.shape[:-1], u.shape[:-1]), n, n))

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, n, 0)"""
        return np.zeros((*np.broadcast_shapes(x.shape[:-1], u.shape[:-1]), x.shape[-1], 0))

    def M(self, u: Array) -> Array:
        """No input, no noise of it : (…, 0, 0)"""
        return np.zeros((*u.shape[:-1], 0, 0))

    def Q(self, u: Array) -> Array | float:
        """How far the parameters may wander from step to step : (n, n)"""
        return self.process

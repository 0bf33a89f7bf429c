"""Motions of one robot, in plain floats: several times as fast as arrays of three."""

import math
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.geometry import Array
from ekfsim.models.noise import independent

if TYPE_CHECKING:  # each takes its time to import, and a run has one of them
    from ekfsim.models.motions.move_turn import MoveTurn
    from ekfsim.models.motions.unicycle import Unicycle
    from ekfsim.models.motions.wheel_speeds import WheelSpeeds
    from ekfsim.models.motions.wheels import GyroWheels

Linearized = tuple[Array, Array, Array, Array, Array | float]  # f, F, G, M, Q


def move_turn_f(motion: "MoveTurn", x: Array, u: Array) -> Array | None:
    """Twin of `MoveTurn.f`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, θ), (d, a) = x.tolist(), u.tolist()
    return np.array([px + d * math.cos(θ), py + d * math.sin(θ), wrap_one(θ + a)])


def move_turn(motion: "MoveTurn", x: Array, u: Array) -> Linearized | None:
    """Twin of f, F, G, M and Q of `MoveTurn`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, θ), (d, a) = x.tolist(), u.tolist()
    c, s = math.cos(θ), math.sin(θ)
    return (
        np.array([px + d * c, py + d * s, wrap_one(θ + a)]),
        np.array([[1.0, 0.0, -d * s], [0.0, 1.0, d * c], [0.0, 0.0, 1.0]]),
        np.array([[c, 0.0], [s, 0.0], [0.0, 1.0]]),
        np.array([[(motion.distance_ratio * d) ** 2, 0.0], [0.0, (motion.angle_ratio * a) ** 2]]),
        0.0,
    )


def gyro_wheels_f(motion: "GyroWheels", x: Array, u: Array) -> Array | None:
    """Twin of `GyroWheels.f`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, Φ), (left, right, ω, dt) = x.tolist(), u.tolist()
    ΔD, middle = (right + left) / 2, Φ + ω * dt / 2
    return np.array([px + ΔD * math.cos(middle), py + ΔD * math.sin(middle), wrap_one(Φ + ω * dt)])


def gyro_wheels(motion: "GyroWheels", x: Array, u: Array) -> Linearized | None:
    """Twin of f, F, G, M and Q of `GyroWheels`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, Φ), (left, right, ω, dt) = x.tolist(), u.tolist()
    ΔD, b, middle = (right + left) / 2, motion.width, Φ + ω * dt / 2
    c, s = math.cos(middle), math.sin(middle)
    dx, dy = ΔD * c, ΔD * s
    lever_x, lever_y, half_t, half_ω = dx / (2 * b), dy / (2 * b), dt / 2, ω / 2
    return (
        np.array([px + dx, py + dy, wrap_one(Φ + ω * dt)]),
        np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]]),
        np.array(
            [
                [c / 2 + lever_y, c / 2 - lever_y, -dy * half_t, -dy * half_ω],
                [s / 2 - lever_x, s / 2 + lever_x, dx * half_t, dx * half_ω],
                [-1 / b, 1 / b, dt, ω],
            ]
        ),
        independent(motion.wheel_sigma, motion.wheel_sigma, motion.gyro_sigma, 0.0),
        motion.process,
    )


def unicycle_f(motion: "Unicycle", x: Array, u: Array) -> Array | None:
    """Twin of `Unicycle.f`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, θ), (v, ω, dt) = x.tolist(), u.tolist()
    middle, D = θ + ω * dt / 2, v * dt
    return np.array([px + D * math.cos(middle), py + D * math.sin(middle), wrap_one(θ + ω * dt)])


def unicycle(motion: "Unicycle", x: Array, u: Array) -> Linearized | None:
    """Twin of f, F, G, M and Q of `Unicycle`."""
    if not x.ndim == u.ndim == 1:
        return None
    (px, py, θ), (v, ω, dt) = x.tolist(), u.tolist()
    middle, per_second = θ + ω * dt / 2, 1 / dt if dt > 0 else 0.0
    c, s = math.cos(middle), math.sin(middle)
    dx, dy, h = v * dt * c, v * dt * s, dt / 2
    way, turn = motion.distance_density, motion.heading_density
    return (
        np.array([px + dx, py + dy, wrap_one(θ + ω * dt)]),
        np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]]),
        np.array(
            [
                [c * dt, -dy * h, v * c - dy * ω / 2],
                [s * dt, dx * h, v * s + dx * ω / 2],
                [0.0, dt, ω],
            ]
        ),
        np.diag([way**2 * per_second, turn**2 * per_second, 0.0]),
        0.0,
    )


def wheel_speeds(motion: "WheelSpeeds", x: Array, u: Array) -> Linearized | None:
    """Twin of f, F, G, M and Q of `WheelSpeeds`."""
    if not x.ndim == u.ndim == 1:
        return None
    (_, φ, px, py), (left, right, dt) = x.tolist(), u.tolist()
    V, R, per_second = (left + right) / 2, motion.half_track, 1 / dt if dt > 0 else 0.0
    rate, turned = (right - left) / (2 * R), dt / (2 * R)
    φ += rate * dt
    c, s = math.cos(φ), math.sin(φ)
    dx, dy = V * c * dt, V * s * dt
    q_V, q_φ = motion.speed_density**2 * per_second, (R * motion.turn_density) ** 2 * per_second
    return (
        np.array([V, wrap_one(φ), px + dx, py + dy]),
        np.array([[0.0] * 4, [0.0, 1.0, 0.0, 0.0], [0.0, -dy, 1.0, 0.0], [0.0, dx, 0.0, 1.0]]),
        np.array(
            [
                [0.5, 0.5, 0.0],
                [-turned, turned, rate],
                [c * dt / 2 + dy * turned, c * dt / 2 - dy * turned, V * c - dy * rate],
                [s * dt / 2 - dx * turned, s * dt / 2 + dx * turned, V * s + dx * rate],
            ]
        ),
        np.array([[q_V + q_φ, q_V - q_φ, 0.0], [q_V - q_φ, q_V + q_φ, 0.0], [0.0] * 3]),
        0.0,
    )

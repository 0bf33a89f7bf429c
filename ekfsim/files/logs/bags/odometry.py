"""What a topic of poses or speeds tells of the motion."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ekfsim.files.logs.bags.messages import SECOND, pose_of, seconds, twist_of
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap

JUMP = 0.3  # m or rad, which no message that only rounds moves
BEYOND = 3.0  # times what an odometry's own speeds tell is more than they err
USUAL, FASTER = (
    99,
    10.0,
)  # a percentile of all speeds, and how much more none is, where none is told
SIDEWAYS = 0.2  # of the way, from which on it is told that a robot moves aside


class Poses(NamedTuple):
    """The poses of an odometry that never began anew, and what is to be told of them."""

    rows: list[tuple[int, float, float, float]]  # ns, x, y in m, θ in rad
    told: list[str]


def tells_speeds(messages: Sequence[tuple[int, Any]]) -> bool:
    """Whether an odometry tells speeds, and no way: without poses, with headings that are none, or
    with one pose all the time.
    """
    if not all(hasattr(message, "pose") for _, message in messages):
        return all(twist_of(message) is not None for _, message in messages)
    poses = {pose_of(message) for _, message in messages}
    no_heading = all(math.isnan(pose[2]) for pose in poses)
    return (no_heading or len(poses) == 1) and twist_of(messages[0][1]) is not None


def speeds_of(messages: Sequence[tuple[int, Any]]) -> tuple[list[tuple[int, float, float]], str]:
    """ns, speed ahead in m/s and turn rate in rad/s of each message; what is to be told of them."""
    twists = [(t, twist_of(message)) for t, message in messages]
    rows = [(t, twist.linear.x, twist.angular.z) for t, twist in twists]
    aside = sum(abs(twist.linear.y) for _, twist in twists)
    if aside <= SIDEWAYS * sum(abs(v) for _, v, _ in rows):
        return rows, ""
    return rows, "it tells speeds to the side (linear.y): a robot on wheels has none, left out"


def poses_of(messages: Sequence[tuple[int, Any]]) -> Poses:
    """The poses of an odometry in the order of time. Where it began anew, its pose jumps: what
    follows is laid on to where its speeds lead, or to where it was where it tells none.
    """
    messages = sorted(messages, key=lambda one: one[0])
    t = np.array([one for one, _ in messages])
    poses = np.array([pose_of(message) for _, message in messages]).reshape(-1, 3)
    dt = np.diff(t - t[0]) / SECOND if len(t) else np.zeros(0)
    twists = [twist_of(message) for _, message in messages]
    v = np.array([0.0 if one is None else one.linear.x for one in twists])
    ω = np.array([0.0 if one is None else one.angular.z for one in twists])
    way = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    turn = np.abs(wrap(np.diff(poses[:, 2])))
    jumps = np.flatnonzero(_jumps(way, v, dt) | _jumps(turn, ω, dt))
    for k in jumps.tolist():
        span = dt[k] if np.any(v) or np.any(ω) else 0.0
        poses[k + 1 :] = _laid_on(poses[k + 1 :], poses[k], v[k] * span, ω[k] * span)
    told = []
    if len(jumps):
        k = int(jumps[0])
        more = f", and {len(jumps) - 1} times more" if len(jumps) > 1 else ""
        told.append(
            f"at {seconds(int(t[k + 1]))} s its pose jumps by {way[k]:.3g} m and "
            f"{math.degrees(turn[k]):.3g}° in {dt[k]:.3g} s{more}: taken as an odometry that began "
            "anew; its speeds, where it tells any, count over that time"
        )
    rows = [(int(at), x, y, θ) for at, (x, y, θ) in zip(t, poses.tolist(), strict=True)]
    return Poses(rows, told)


def _jumps(step: Array, speed: Array, dt: Array) -> Booleans:
    """Which steps are none that was driven. step (n,), speed (n + 1,), dt (n,) : (n,)"""
    near = np.abs(np.stack([speed[:-1], speed[1:]])).max(axis=0, initial=0.0)
    if np.any(speed):
        beyond: Booleans = step > JUMP + BEYOND * near * dt
        return beyond
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = np.where(dt > 0, step / dt, 0.0)
    moving = rate[np.isfinite(rate) & (rate > 0)]
    usual = float(np.percentile(moving, USUAL)) if len(moving) else math.inf
    beyond = (step > JUMP) & (rate > FASTER * usual)
    return beyond


def _laid_on(poses: Array, before: Array, ahead: float, turned: float) -> Array:
    """Poses (n, 3) moved so that the first lies so far ahead of and turned from the one before."""
    middle = before[2] + turned / 2
    first = before + np.array([ahead * math.cos(middle), ahead * math.sin(middle), turned])
    rotation = first[2] - poses[0, 2]
    c, s = math.cos(rotation), math.sin(rotation)
    off = poses[:, :2] - poses[0, :2]
    x, y = c * off[:, 0] - s * off[:, 1], s * off[:, 0] + c * off[:, 1]
    return np.column_stack([first[0] + x, first[1] + y, poses[:, 2] + rotation])

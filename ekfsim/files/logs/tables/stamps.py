"""What one of a stamp is: found by what the numbers can be, where nobody says.

The stamps of a robot's motion are seconds unless their usual step would be absurd for the robot;
those of readings and truth are what lies within the motion. A unit is a power of ten, so that
stamps become seconds by their digits: 1248444187156000000 ns are read as 1248444187.156 would be.
"""

from collections.abc import Sequence

import numpy as np

from ekfsim.geometry import Array

POWER = {"s": 0, "ms": -3, "us": -6, "ns": -9}
SPOKEN = {"s": "seconds", "ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
SINCE_1970 = 1e10  # beyond it a number is no stamp in s: it would be of the year 2286 or later
DATES = 6e8, 4.2e9  # s since 1970: 1989 to 2103
LONG_STEP = 20  # of the robot's own steps from which on a usual step is in doubt …
SLOW = 2.0  # s; … and that is longer than this: many loggers write once a second
SHORTEST = 1e-4  # s; no robot is logged more often
SPARSE = 20  # readings and truth come at most so many times as often as motions
# shares of stamps within the motion: too few to be seconds, enough to be of another unit
FEW, MOST = 0.02, 0.5


def to_seconds(text: str, unit: str) -> float:
    """The seconds that a stamp's digits say, rounded once.

    >>> to_seconds("1248444187156000000", "ns"), to_seconds("1.5e3", "ms")
    (1248444187.156, 1.5)
    """
    mantissa, _, power = text.strip().lower().partition("e")
    if not mantissa[-1:].isdigit() and mantissa[-1:] != ".":
        return float(text)  # nan, inf
    return float(f"{mantissa}e{int(power or 0) + POWER[unit]}")


def usual_step(t: Array) -> float:
    """The median of the steps between different stamps, in their own unit; 0 where there is none.
    t : (n,)
    """
    steps = np.diff(np.sort(t[np.isfinite(t)]))
    steps = steps[steps > 0]
    return float(np.median(steps)) if len(steps) else 0.0


def unit_of_motion(t: Array, own_step: float) -> tuple[str, str]:
    """The unit of a motion's stamps, and why it is not s ("" where it is).
    t : (n,) as they stand; own_step : s, that of the robot
    """
    step, longest = usual_step(t), max(LONG_STEP * own_step, SLOW)
    date = _unit_of_date(t)
    if step <= longest and date is None:
        return "s", ""
    likely = [
        unit for unit in ("ms", "us", "ns") if SHORTEST <= step * 10.0 ** POWER[unit] <= longest
    ]
    if date is not None and (date in likely or not likely):
        return date, f"{_median(t):.6g} s would be no date"
    if not likely or step <= longest:
        return "s", ""
    nearest = min(likely, key=lambda unit: abs(np.log(step * 10.0 ** POWER[unit] / own_step)))
    return nearest, f"the usual step would be {step:.4g} s"


def unit_beside(t: Array, motion: Array) -> tuple[str, str]:
    """The unit of the stamps of readings or of the truth, and why it is not s.
    t : (n,) as they stand; motion : (m,) s
    """
    known, step = t[np.isfinite(t)], usual_step(t)
    often = max(SHORTEST, usual_step(motion) / SPARSE)
    within = {
        unit: _share(known * 10.0**power, motion)
        for unit, power in POWER.items()
        if unit == "s" or step == 0 or step * 10.0**power >= often
    }
    best = max(within, key=lambda unit: within[unit])
    if within["s"] < FEW and within[best] >= MOST:
        share = f"{within['s']:.0%}" if within["s"] else "none"
        return best, f"as seconds {share} of them would lie within the motion"
    date = _unit_of_date(t)
    if date is not None and within["s"] == 0:
        return date, f"{_median(t):.6g} s would be no date"
    return "s", ""


def _share(t: Array, motion: Array) -> float:
    """How many of some instants lie within the motion, but for one: 0 does in every unit."""
    if not len(t) or not len(motion):
        return 0.0
    within = int(np.sum((t >= motion.min()) & (t <= motion.max())))
    return max(within - 1, 0) / max(len(t) - 1, 1)


def _unit_of_date(t: Array) -> str | None:
    """The one unit, other than s, in which stamps are dates of our time; None where there is no
    such.
    """
    median = _median(t)
    if not median >= SINCE_1970:
        return None
    dates = (
        unit for unit in ("ms", "us", "ns") if DATES[0] <= median * 10.0 ** POWER[unit] <= DATES[1]
    )
    return next(dates, None)


def _median(t: Array) -> float:
    known = np.abs(t[np.isfinite(t)])
    return float(np.median(known)) if len(known) else 0.0


def seconds_of(texts: Sequence[str], unit: str) -> Array:
    """Stamps in s : (n,)"""
    return np.array([to_seconds(text, unit) for text in texts])

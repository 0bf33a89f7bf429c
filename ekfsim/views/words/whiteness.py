"""What is said of the innovations of a run: whether they are white, and what kind of thing they
show where they are not.
"""

import numpy as np

from ekfsim.diagnostics.innovations import LEVEL, Found
from ekfsim.diagnostics.whiteness import LEAST, Whiteness
from ekfsim.geometry import Array


def sentence(found: Found) -> str:
    """Whether the innovations are white around zero, and the evidence.

    Lags are told to two digits, means in units of the innovations' own σ.
    """
    out = left_out(found)
    if found.word == "no evidence":
        most = max((int(one.readings) for one in found.sensors), default=0)
        readings = "1 reading" if most == 1 else f"{most} readings"
        return f"no evidence: {readings} of one sensor, and {LEAST} are wanted{out}"
    told = ", ".join(f"{int(one.readings)} of {one.sensor}" for one in found.sensors)
    if found.word == "white":
        return f"white around zero (p {float(found.p):.2g}; {told}{out})"
    return f"not white (p {float(found.p):.2g}; {told}{out}): {reason(found)}"


def left_out(found: Found) -> str:
    """How many readings were left out, and why; nothing where there were none."""
    counts = (
        (found.no_reading, "without a reading"),
        (found.refused, "refused"),
        (found.certain, "certain beforehand"),
    )
    told = [f"{int(n)} {why}" for n, why in counts if n]
    return f"; left out: {', '.join(told)}" if told else ""


def reason(found: Found) -> str:
    """What shows that they are not white, of the sensor that shows it most: a bias, errors that
    last, or both.
    """
    one = min(found.sensors, key=lambda one: np.min(asked(one)))
    of_lags, of_targets, of_mean = asked(one) * found.tests < LEVEL
    told = [bias(one)] if of_mean else []
    if of_lags and one.p_lags <= asked(one)[1]:
        told.append(
            f"each of {one.sensor} errs {like(one.lags)} the ones before it "
            f"(lags 1 to {lags(one.lags)})"
        )
    elif of_targets:
        told.append(
            f"each of {one.sensor} errs {like(one.target_lags)} those of the same target before it "
            f"(lags 1 to {lags(one.target_lags)})"
        )
    return "; ".join(told)


def asked(one: Whiteness) -> Array:
    """The p of the tests of a sensor, 1 of one that was not asked."""
    return np.where(np.isnan(one.tests), 1.0, one.tests)


def bias(one: Whiteness) -> str:
    """The mean that is farthest from zero, in units of its own σ."""
    z = np.nan_to_num(abs(one.means)) * np.sqrt(one.target_readings)[..., None]
    target, number = np.unravel_index(int(np.argmax(z)), z.shape)
    mean = float(one.means[target, number])
    name = one.targets[target]
    of = (
        one.sensor if name == one.sensor else name if one.sensor in name else f"{one.sensor} {name}"
    )
    side = "above" if mean > 0 else "below"
    return (
        f"the {one.quantities[number]} of {of} lies {abs(mean):.2g}σ {side} its prediction on the "
        f"average of {int(one.target_readings[target])}, a bias and no noise"
    )


def like(r: Array) -> str:
    """Whether errors go on with their sign, or change it."""
    first = r[np.nanargmax(abs(r))]
    return "like" if first > 0 else "against"


def lags(r: Array) -> str:
    """The lags that were asked: "5: 0.67 0.56 0.65 0.64 0.55"."""
    known = r[~np.isnan(r)]
    return f"{len(known)}: {' '.join(f'{one:.2f}' for one in known)}"

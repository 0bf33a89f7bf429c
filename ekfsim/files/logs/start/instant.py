"""At which instant the filter of a recorded log begins."""

from collections.abc import Sequence

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.logs.truth import Truth
from ekfsim.geometry import Array


def of_the_motion(
    truth: Truth, start: float, ends: Array, name: str, warnings: list[str]
) -> Truth | None:
    """The truth; None where it ends before the motion begins, or begins after its end, as where
    somebody cut both out of a longer log: it is unknown then, and that is told. ends : (n,) s

    Raises UsageError where they are so far apart that their clocks must differ.
    """
    apart = max(start - truth.t[-1], truth.t[0] - ends[-1])
    if apart <= 0 and truth.t[0] < ends[-1]:
        return truth
    told = (
        f"the truth and the motion have no instant in common: the truth is of {span(truth.t)}, "
        f"the motion of {span([start, ends[-1]])}"
    )
    if apart > max(float(ends[-1]) - start, float(np.ptp(truth.t))):
        raise UsageError(f"{name}: {told}; put them on one clock, or take the truth away")
    warnings.append(f"{name}: {told}: the truth is unknown, and so are the errors")
    return None


def first_known(
    truth: Truth, start: float, ends: Array, name: str, warnings: list[str]
) -> float | None:
    """The first instant of a log at which its true pose is known; None where it is at none.
    ends : (n,) s, of the motions
    """
    if np.isfinite(truth.at(np.array([start]))).all():
        return start
    later = truth.t[(truth.t > start) & (truth.t < ends[-1])]
    if not len(later):
        warnings.append(f"{name}: no true pose is of the time of the motion: the truth is unknown")
        return None
    first, before = float(later[0]), truth.t[truth.t < start]
    begins = f"is known again, after a gap from {before[-1]:.12g} s" if len(before) else "begins"
    warnings.append(
        f"{name}: starts at {first:.12g} s, where the truth {begins}: what was before is left out"
    )
    return first


def tell_unknown(truth: Truth, start: float, ends: Array, name: str, warnings: list[str]) -> None:
    """Warn of the time at either end of a log at which its errors are not known."""
    if (before := float(truth.t[0]) - start) > 0:
        told = f"the truth begins {before:.3g} s after the motion: errors are counted from then on"
        warnings.append(f"{name}: {told}")
    gaps = np.diff(truth.t)[(truth.t[1:] > start) & (truth.t[:-1] < ends[-1])]
    if len(gaps := gaps[gaps > truth.longest]):
        which = "a gap" if len(gaps) == 1 else f"{len(gaps)} gaps"
        told = f"the truth is unknown over {which}, {gaps.sum():.3g} s in all"
        warnings.append(f"{name}: {told}: no errors are counted there")
    if (after := float(ends[-1] - truth.t[-1])) > truth.longest:
        told = f"the truth ends {after:.3g} s before the motion: errors are counted until then"
        warnings.append(f"{name}: {told}")


def span(t: Array | Sequence[float]) -> str:
    """The first and the last of some instants; of two clocks it shows how far they are apart."""
    return f"{np.min(t):.12g} to {np.max(t):.12g} s"

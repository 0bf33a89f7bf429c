"""What a step changed, in the words of a picture: how far the estimate moved, which uncertainty
grew or shrank, what a reading was worth, and whether it was the one that lost the run.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.ambiguity import BeamSensor
from ekfsim.diagnostics.nees import error
from ekfsim.diagnostics.verdict import LOST, SURPRISING
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Correction, Gaussian, posed
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_halfwidth, ellipse
from ekfsim.models.sensors.mounted import bare, place_of
from ekfsim.records import Control, Reading
from ekfsim.views.playback.view import View
from ekfsim.views.words.judgement import fatal
from ekfsim.views.words.numbers import figure, length

ARROWS = "→↗↑↖←↙↓↘"
STILL = 5e-5  # m; an estimate that moved by less stays where it is
UNTURNED = math.radians(0.005)
ALIKE = 0.005  # share by which a size must change to be told
CONE = "the heading's cone"
NO_NUMBER = "the estimate is no number"
NO_IDEA = "it has no idea yet where it is: its particles lie all over the room"


class Size(NamedTuple):
    """How uncertain a belief is in one way, before and after a step: m, or rad of a heading."""

    name: str
    before: float
    after: float
    angular: bool = False

    @property
    def ratio(self) -> float:
        """How many times as large it is after it; 1 where it was and is nothing."""
        if self.before > 0:
            return self.after / self.before
        return math.inf if self.after > 0 else 1.0

    @property
    def told(self) -> str:
        """As a picture has it: "the major radius shrank from 47.2 cm to 11.3 cm"."""
        verb = "grew" if self.after > self.before else "shrank"
        return f"{self.name} {verb} from {self._told(self.before)} to {self._told(self.after)}"

    def _told(self, size: float) -> str:
        return f"± {math.degrees(size):.3g}°" if self.angular else length(size)


def revised(view: View, probability: float) -> str:
    """What a reading that was used did to the estimate, and what it was worth."""
    correction = view.step.correction
    assert correction is not None
    before, after = posed(view.step.prior, view.layout), view.pose
    if not _finite(after):
        return NO_NUMBER
    if view.unplaced:
        return "; ".join([NO_IDEA, *worth(correction)])
    if view.was_unplaced:
        return "; ".join(["its particles gather: now it has an idea", *worth(correction)])
    sizes = list(_sizes(view, before, after, probability))
    if not any(size.before for size in sizes):
        return "; ".join(["nothing was uncertain, so the estimate stays", *worth(correction)])
    most = min(sizes, key=lambda size: size.ratio)
    shrunk = most.told if most.ratio < 1 - ALIKE else "it is hardly more certain than before"
    return "; ".join([moved(before, after), shrunk, *worth(correction)])


def carried(view: View, probability: float) -> str:
    """By how much the motion of a view made the estimate less certain; nothing where it did not."""
    if not isinstance(view.step.entry.given, Control):
        return ""
    before = posed(view.step.prior if view.before is None else view.before, view.layout)
    if not _finite(view.pose):
        return NO_NUMBER
    if view.unplaced or view.was_unplaced:
        return NO_IDEA if view.unplaced else ""
    sizes = [
        size
        for size in _sizes(view, before, view.pose, probability)
        if size.name in ("the major radius", CONE) and abs(size.ratio - 1) > ALIKE
    ]
    return ", ".join(size.told for size in sizes)


def moved(before: Gaussian, after: Gaussian) -> str:
    """How far an estimate moved and turned."""
    east, north, turned = error(after, before.mean).tolist()
    distance = math.hypot(east, north)
    arrow = ARROWS[round(math.atan2(north, east) / (math.pi / 4)) % 8]
    told = [f"moved {length(distance)} {arrow}"] if distance >= STILL else []
    if abs(turned) >= UNTURNED:
        side = "left" if turned > 0 else "right"
        told.append(f"turned {math.degrees(abs(turned)):.3g}° {side}")
    return f"the estimate {' and '.join(told) or 'stays where it is'}"


def worth(correction: Correction) -> Iterator[str]:
    """What a reading was worth: how surprising it was; nothing where nothing was uncertain."""
    nis, numbers = float(correction.nis), len(correction.innovation)
    if math.isnan(nis):
        return
    word = (
        "as expected"
        if nis <= quantile(SURPRISING, numbers)
        else "surprising"
        if nis <= quantile(LOST, numbers)
        else "very surprising"
    )
    off = f"{math.sqrt(nis):.2g}σ" if numbers == 1 else f"NIS {figure(nis)} of {numbers}"
    yield f"the reading was {word} ({off})"


def losing(view: View, names: Sequence[str]) -> str:
    """That the run is lost since this very view, and how far off the estimate is; else nothing.
    In the last view the verdict says as much. names : of the filters that watch
    """
    truth, given = view.step.entry.truth, view.step.entry.given
    every = zip(names, (view, *view.others), strict=True)
    lost = [(name, one) for name, one in every if fatal(one)]
    if view.judged.closing is not None or truth is None or not lost:
        return ""
    what = "reading" if isinstance(given, Reading) else "step"
    when = f"with this {what}" if view.step.entry.index else "from the start"
    if view.others:
        told = (f"{name} (off by {_off(one.pose, truth)})" for name, one in lost)
        return f"lost {when}: {', '.join(told)}"
    off = f"off by {_off(view.pose, truth)}"
    if not isinstance(given, Reading):
        return f"lost {when}: {off}"
    before = _off(posed(view.step.prior, view.layout), truth)
    return f"lost {when}: {off}, before by {before}"


def _off(pose: Gaussian, truth: Array) -> str:
    east, north, turned = error(pose, truth).tolist()
    return f"{length(math.hypot(east, north))} and {math.degrees(abs(turned)):.3g}°"


def _sizes(view: View, before: Gaussian, after: Gaussian, probability: float) -> Iterator[Size]:
    """How uncertain the pose was and is."""
    given = view.step.entry.given
    if isinstance(given, Reading) and isinstance(sensor := bare(given.sensor), BeamSensor):
        along = place_of(given.sensor, before.mean)[2] + sensor.bearing
        yield Size("σ along the beam", _sigma(before, along), _sigma(after, along))
    was, now = (ellipse(pose.covariance, probability) for pose in (before, after))
    yield Size("the major radius", float(was.major), float(now.major))
    yield Size("the minor radius", float(was.minor), float(now.minor))
    was_wide, is_wide = (
        cone_halfwidth(float(pose.covariance[2, 2]), probability) for pose in (before, after)
    )
    yield Size(CONE, was_wide, is_wide, angular=True)


def _sigma(pose: Gaussian, angle: float) -> float:
    """Standard deviation of the position along a direction, in m."""
    d = np.array([math.cos(angle), math.sin(angle)])
    return math.sqrt(max(float(d @ pose.covariance[:2, :2] @ d), 0.0))


def _finite(pose: Gaussian) -> bool:
    return bool(np.isfinite(pose.mean).all() and np.isfinite(pose.covariance).all())

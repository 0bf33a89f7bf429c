"""The shapes of a view's belief in the plane, found once for all Axes that they are drawn in."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_halfwidth, ellipse, outline
from ekfsim.views.playback.view import View
from ekfsim.views.words.judgement import Standing, standing

NO_POSE = np.full(3, np.nan)  # of a belief that tells no place


@dataclass(frozen=True, slots=True)
class Region:
    """Where a belief takes the robot to be. All in m and rad."""

    pose: Array  # (3,)
    rim: Array  # of the ellipse : (n, 2)
    half: float  # half the opening of the cone


NO_REGION = Region(NO_POSE, NO_POSE[None, :2], 0.0)


@dataclass(frozen=True, slots=True)
class Shape:
    """A view, and what is drawn of its belief."""

    view: View
    region: Region
    radius: float  # the ellipse's larger one, in m
    before: Region | None  # what was believed before, where that is something else
    stands: Standing
    path: Array  # (n, 2) m
    true: Array  # (n, 2) m, the way of the truth
    reckoned: Array  # (n, 2) m, the way by odometry alone

    @classmethod
    def of(cls, view: View, probability: float) -> Self:
        """probability : of the ellipse and the cone"""
        earlier = view.earlier
        return cls(
            view,
            NO_REGION if view.unplaced else _region(*view.pose, probability),
            float(ellipse(view.pose.covariance, probability).major),
            None if earlier is None else _region(*earlier, probability),
            standing(view, probability),
            view.path(),
            view.true.points(),
            view.reckoned.points(),
        )


def _region(x: Array, P: Array, probability: float) -> Region:
    half = cone_halfwidth(float(P[2, 2]), probability)
    return Region(x, outline(x, P[:2, :2], probability), half)

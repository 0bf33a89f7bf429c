"""Document 003's run, filtered as it should be and as the document's authors did."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.figures.over_runs import RUNS, EachRun
from ekfsim.figures.retold import retold
from ekfsim.figures.track import Track
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.localization import filter_of, first_belief, localize, play
from ekfsim.records import Entry, Reading, Step
from ekfsim.scene import Scene
from ekfsim.simulation import simulate

COURSE = 1.0  # s between the two fixes that a course over ground is made of
CREEPING = 0.6  # m, a shorter way between them tells no course
FINE = 1e-9  # s, what rounding makes of an instant
FILTER, RECIPE = "filter, with dt", "authors' recipe"


@dataclass(frozen=True)
class Fixes:
    """The fixes as they were recorded."""

    t: Array  # (K,) s
    place: Array  # (K, 2) m
    truth: Array  # (K, 3)

    @classmethod
    def of(cls, track: Track) -> "Fixes":
        """Those that the filter of a track was given."""
        t = np.array([reading.t for reading in track.readings])
        place = np.array([reading.z for reading in track.readings]).reshape(-1, 2)
        rows = np.minimum(np.searchsorted(track.t, t - FINE), len(track.t) - 1)
        return cls(t, place, track.truth[rows])

    @property
    def error(self) -> Array:
        """(K, 2) m"""
        return self.place - self.truth[:, :2]

    def courses(self) -> tuple[Array, Array]:
        """Halfway between two fixes a second apart,
        and the course from one to the other : (J,) s, (J,) rad
        """
        later = np.searchsorted(self.t, self.t + COURSE - FINE)
        first = np.flatnonzero(later < len(self.t))
        later = later[first]
        way = self.place[later] - self.place[first]
        moved = np.hypot(way[:, 0], way[:, 1]) > CREEPING
        return ((self.t[first] + self.t[later]) / 2)[moved], np.arctan2(way[:, 1], way[:, 0])[moved]


@dataclass(frozen=True)
class Runs:
    """One run, filtered as it should be and as the document's authors did."""

    right: Track  # the document's filter, written with dt
    recipe: Track  # what its authors' code does
    sparse: Track  # the same recipe, corrected at the recorded fixes alone
    fixes: Fixes
    chosen: str  # which of the first two the figures 1 to 5 show: FILTER or RECIPE

    @classmethod
    def of(cls, scene: Scene) -> "Runs":
        """Filter the scene three times."""
        right, coded = retold(scene, "corrected"), retold(scene, "coded")
        track = Track.of(play(right), scene.world.layout)
        log = simulate(coded) if coded.log is None else coded.log.entries
        return cls(
            track,
            Track.of(play(coded), scene.world.layout),
            _filtered(coded, log),
            Fixes.of(track),
            RECIPE if scene.reading == "coded" else FILTER,
        )

    @property
    def estimate(self) -> Track:
        """The one that figures 1 to 5 show."""
        return self.right if self.chosen == FILTER else self.recipe

    @property
    def wheels(self) -> Array:
        """(N, 3) the poses that the wheels alone make of the first one, at `right.t`"""
        return self.right.layout.pose(self.right.reckoned)


@dataclass(frozen=True)
class ManyRuns:
    """Many simulated runs of a scene, filtered in both ways."""

    right: EachRun
    recipe: EachRun
    fixes: Array  # (N,) m, RMSE of the raw fixes

    @classmethod
    def of(cls, scene: Scene) -> "ManyRuns":
        """Filter the runs twice."""
        squares = list[Array]()

        def seen(steps: Iterable[Step]) -> Iterator[Step]:
            for step in steps:
                if isinstance(step.entry.given, Reading) and step.entry.truth is not None:
                    squares.append(
                        np.sum((step.entry.given.z - step.entry.truth[:, :2]) ** 2, axis=-1)
                    )
                yield step

        layout, numbers = scene.world.layout, np.arange(RUNS)
        right = EachRun.of(seen(play(retold(scene, "corrected"), numbers)), layout)
        recipe = EachRun.of(play(retold(scene, "coded"), numbers), layout)
        return cls(right, recipe, np.sqrt(np.nanmean(squares, axis=0)))


def pose_error(pose: Array, truth: Array) -> Array:
    """(N, 3) m, m, rad, the heading wrapped"""
    error = pose - truth
    error[:, 2] = wrap(error[:, 2])
    return error


def length(error: Array) -> Array:
    """Of errors (N, 2) in m : (N,) m"""
    return np.asarray(np.hypot(error[:, 0], error[:, 1]), np.float64)


def _filtered(scene: Scene, entries: Iterable[Entry]) -> Track:
    layout = scene.world.layout
    return Track.of(
        localize(entries, filter_of(scene), first_belief(scene), scene.guard, layout), layout
    )

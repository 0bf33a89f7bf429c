"""The long form of the narrative:
what else is needed to check each number by hand, and by which equation it comes.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.diagnostics.ambiguity import REACH, sighting_of
from ekfsim.filters.belief import Correction, posed
from ekfsim.geometry import Array
from ekfsim.records import Control, Step
from ekfsim.scene import Scene
from ekfsim.views.playback.view import View
from ekfsim.views.words.beams.told import corners, others_met, wall_name, walls_of
from ekfsim.views.words.narrative.origins import Origins, named, origins
from ekfsim.views.words.numbers import fine, matrix, number, pose, state

WORDS = """\
matrices, derivatives  in m and rad; P' is P transposed, P^-1 its inverse
innovation  what was measured less what was predicted, r = z - h
NIS         r' S^-1 r, the innovation beside what S lets expect: on average 1 a number read, where \
the filter is right
NEES        e' P^-1 e, the same of the estimate's error e: on average as much as its degrees of \
freedom
degrees of freedom  how many independent numbers such a sum of squares is of
guard       what becomes of ambiguous beams: warn tells them, skip leaves their readings out, off \
does neither
run         one of the courses that a scene's noise may take: --run K plays number K
"""
RATIOS = (
    "eq 1: (odometryDstSigmaRatio * distance)^2 and (odometryAngSigmaRatio * angle)^2, uncorrelated"
)
ON_ITS_ARM = 1 - 1e-9  # a pose that is less far along its arm was drawn back


class Form:
    """The short form, which tells nothing of this."""

    words = ""

    def by(self, what: str) -> str:
        """Whence the number before it comes. what : a field of Origins"""
        return ""

    def carried(self, view: View) -> str:
        """What a motion input does to a belief:
        the covariance of its noise, and what it makes of P.
        """
        return ""

    def doubted(self, step: Step) -> str:
        """Of an ambiguous beam the poses that disagree,
        and the walls that it would meet from there.
        """
        return ""

    def expected(self, step: Step) -> str:
        """The corners of the wall that a beam was expected to meet;
        nothing of a sensor that sends none.
        """
        return ""

    def noise(self, c: Correction) -> str:
        """R and S of a reading."""
        return ""


SHORT = Form()


@dataclass(frozen=True)
class LongForm(Form):
    """The long form of one scene."""

    origins: Origins
    classroom: bool  # whose names and equations are the assignment's

    words = WORDS

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """In the words of the scene's filter."""
        return cls(origins(scene), scene.commanded)

    def by(self, what: str) -> str:
        """Whence the number before it comes. what : a field of Origins"""
        return self._by(getattr(self.origins, what))

    def carried(self, view: View) -> str:
        """What a motion input does to a belief:
        the covariance of its noise, and what it makes of P.
        """
        step = view.step
        given, prediction = step.entry.given, step.prediction
        assert isinstance(given, Control)
        assert prediction is not None
        F, G, M, Q = prediction.F, prediction.G, given.motion.M(given.u), given.motion.Q(given.u)
        told = [] if view.inputs == 1 else [self._last_of_many(step)]
        told.append(
            self._matrix(
                "M", RATIOS if self.classroom else "the covariance of the input's noise", M
            )
        )
        if self.origins.linear:
            told.append(self._matrix("F", self.origins.jacobians, F))
        if self.origins.jacobians:
            told += [
                self._matrix("G", self.origins.jacobians, G),
                self._matrix("G M G'", "", G @ M @ G.mT),
            ]
        if self.origins.linear:
            told.append(self._matrix("F P F'", "", F @ step.prior.covariance @ F.mT))
        if np.ndim(Q):
            told.append(self._matrix("Q", "", np.asarray(Q)))
        return "".join(told)

    def doubted(self, step: Step) -> str:
        """Of an ambiguous beam the poses that disagree,
        and the walls that it would meet from there.
        """
        sighting = sighting_of(step)
        if sighting is None or not sighting.ambiguous:
            return ""
        told, (x, P) = "", posed(step.prior, step.layout)
        arms = REACH * np.sqrt(np.maximum(np.linalg.eigvalsh(P), 0.0))
        rounded = 2 * float(np.spacing(np.abs(x)).max())  # of a place at map coordinates
        for i in others_met(walls_of(step), sighting):
            wall, arm = int(sighting.probe_walls[i]), float(arms[i % 3])
            away = float(np.linalg.norm(sighting.probes[i] - x))
            back = ""
            if away < ON_ITS_ARM * arm - rounded:
                back = f", drawn back to {number(away / arm)} of its arm, where the robot can stand"
            met = (
                wall_name(step, wall)
                if wall < 0
                else f"{wall_name(step, wall)}, {corners(step, wall)}"
            )
            after = "" if wall < 0 else f", after {fine(float(sighting.probe_ranges[i]))}"
            told += (
                f"  From (x, y, th) = {pose(sighting.probes[i].tolist())}{back}, "
                f"it would meet {met}{after}\n"
            )
        return told

    def expected(self, step: Step) -> str:
        """The corners of the wall that a beam was expected to meet;
        nothing of a sensor that sends none.
        """
        tangent = step.correction is not None and step.correction.tangent
        sighting = sighting_of(step)
        if tangent or sighting is None or (wall := int(sighting.wall)) < 0:
            return ""
        if walls_of(step).is_round(wall):
            return f"That is a circle {corners(step, wall)}\n"
        return f"That edge, counted from 1 in the file's order, goes {corners(step, wall)}\n"

    def noise(self, c: Correction) -> str:
        """R and S of a reading."""
        if not self.classroom:
            return self._matrix("R", "", c.R) + self._matrix("S", self.origins.S, c.S)
        return (
            f"C_v is {number(float(c.R[0, 0]))}{self.by('range_noise')}\n"
            f"S is {number(float(c.S[0, 0]))}{self.by('S')}\n"
        )

    def _last_of_many(self, step: Step) -> str:
        """The belief that the last of several motion inputs found;
        what follows is of that input.
        """
        x, P = step.prior
        return f"The last input found {state(x, step.layout)} and P:\n{matrix(P)}"

    def _matrix(self, symbol: str, origin: str, A: Array) -> str:
        return f"{named(symbol, self.classroom)} is:{self._by(origin)}\n{matrix(A)}"

    def _by(self, origin: str) -> str:
        told = named(origin, self.classroom)
        return f"   ({told})" if told else ""

"""Whence the numbers of each filter come: the equation, or what stands for it."""

import re
from dataclasses import dataclass, replace

from ekfsim.filters.place import forward
from ekfsim.scene import Scene
from ekfsim.systems import system_of

ASSIGNMENT = {"F": "J_x", "G": "J_u", "M": "P_u", "H": "J_H", "R": "C_v"}  # its names of them


@dataclass(frozen=True)
class Origins:
    """The words behind each number. `eq 4` is the assignment's, told in the classroom alone."""

    state: str = "eq 4: f(x, u)"
    covariance: str = "eq 7: F P F' + G M G' + Q"
    jacobians: str = "eqs 5, 6"
    predicted: str = "eq 8: h(x)"
    derivatives: str = "eq 11: H"
    innovation: str = "eq 9: r = z - h"
    range_noise: str = "(rangeSigmaRatio * predicted range)^2"  # C_v, in the classroom
    S: str = "eq 11: H P H' + R"
    gain: str = "eq 11: P H' S^-1"
    revised: str = "eq 10: x + K r"
    revised_covariance: str = "eq 12: (I - K H) P"
    linear: bool = True  # F P F' is what a motion makes of P


def _tangents(at: str) -> Origins:
    """Of a filter that knows f and h by their tangents at a state x0 that is known beforehand."""
    return Origins(
        state=f"f(x0, u) + F (x - x0), x0 {at}",
        jacobians=f"at x0, {at}",
        predicted=f"h(x0) + H (x - x0), x0 {at}",
        derivatives="H at x0",
        range_noise="(rangeSigmaRatio * range from x0)^2",
    )


SIGMA_POINTS = Origins(
    state="the mean of the sigma points, moved",
    covariance="the spread of the sigma points, moved, + G M G' + Q",
    jacobians="at the state before",
    predicted="the mean of the sigma points' readings",
    derivatives="what stands for them: P_zx P^-1 of the sigma points",
    range_noise="(rangeSigmaRatio * range from the state before)^2",
    S="the spread of the sigma points' readings + R",
    gain="P_xz S^-1 of the sigma points",
    revised_covariance="P - K S K'",
    linear=False,
)

BY_FILTER: dict[str, Origins] = {
    "ekf": Origins(),
    "kf": _tangents("the first state estimate"),
    "kf-nominal": _tangents("on the nominal trajectory"),
    "iekf": Origins(
        derivatives="H where its iterations ended",
        S="eq 11: H P H' + R, H at the state before",
        gain="P H' (H P H' + R)^-1 with H where its iterations ended",
        revised="eq 10: x + K r, iterated",
    ),
    "huber": Origins(
        revised="eq 10: x + w K r",
        revised_covariance="eq 12: (I - w K H) P",
    ),
    "pdaf": Origins(
        revised="eq 10: x + beta K r",
        revised_covariance="(1 - beta) P + beta (I - K H) P + beta (1 - beta) K r r' K'",
    ),
    "adaptive": Origins(
        range_noise="what was learnt so far times (rangeSigmaRatio * predicted range)^2",
    ),
    "invariant": Origins(
        revised="eq 10: x + K r, x and y moved along the arc to it",
        revised_covariance="eq 12: (I - K H) P, x and y turned by the heading's part of K r",
    ),
    "ukf": SIGMA_POINTS,
    "ukf-augmented": replace(
        SIGMA_POINTS,
        covariance="the spread of the sigma points, which hold the noise of M and Q, moved",
        jacobians="",
        S="the spread of the sigma points' readings, which hold the noise of R",
    ),
    "mhekf": Origins(
        state="the mean of all hypotheses, each moved by itself",
        covariance="the spread of all hypotheses",
        predicted="h(x) of the hypothesis that is heaviest after the reading",
        revised="the mean of all hypotheses, each revised by its own wall",
        revised_covariance="the spread of all hypotheses",
        linear=False,
    ),
    "pf": Origins(
        state="the mean of the particles, each moved with a noise of its own",
        covariance="the spread of the particles",
        jacobians="",
        predicted="the mean of the particles' readings",
        derivatives="what stands for them: P_zx P^-1 of the particles",
        range_noise="the mean of each particle's (rangeSigmaRatio * range)^2",
        S="the spread of the particles' readings + R",
        revised="the mean of the particles",
        revised_covariance="the spread of the particles",
        linear=False,
    ),
}
BY_FILTER["amcl"] = BY_FILTER["pf"]
A_FILE = Origins(
    state="as the filter's file has it",
    covariance="as the filter's file has it",
    revised="as the filter's file has it",
    revised_covariance="as the filter's file has it",
)


def origins(scene: Scene) -> Origins:
    """Those of the filter that watches."""
    filter = forward(scene.filter)
    own = BY_FILTER.get(filter, A_FILE)
    if system_of(scene.world.system).by_listing(filter, scene.reading):
        before = "where the robot stood before the last motion"
        own = replace(own, predicted=f"h(x), x {before}", derivatives=f"H {before}")
    if scene.tuning.range_variance == "reading":
        own = replace(own, range_noise="(rangeSigmaRatio * range)^2")
    if scene.tuning.cross_covariances == "dropped":
        dropped = "; then sigma_xtheta and sigma_ytheta are set to 0"
        P, revised = own.covariance + dropped, own.revised_covariance + dropped
        own = replace(own, covariance=P, revised_covariance=revised)
    return own


def named(text: str, classroom: bool) -> str:
    """The words in the assignment's names; elsewhere without the numbers of its equations.

    >>> named("eq 7: F P F' + G M G' + Q", True)
    "eq 7: J_x P J_x' + J_u P_u J_u'"
    >>> named("eq 7: F P F' + G M G' + Q", False), named("eqs 5, 6", False)
    ("F P F' + G M G' + Q", '')
    """
    if classroom:
        words = text.replace(" + Q", "").replace(" S^-1", " / S")
        return re.sub(r"\b[FGMHR]\b", lambda symbol: ASSIGNMENT[symbol[0]], words)
    return re.sub(r"^eqs? [\d, ]+(: |$)", "", text)

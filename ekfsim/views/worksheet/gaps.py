"""Which numbers of a narrative can be calculated from what stands before them.

Commands, odometry and readings are given, the truth is not asked for; states, covariances and all
that leads to them are calculated. A number that is told twice, as the state that the next move
begins with, or an entry of a covariance and its mirror image, is one number.
"""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse
from ekfsim.records import Control, Step
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View
from ekfsim.views.words.narrative.narrating import narrate

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")
ORIGIN = "   ("  # before the equation that the long form tells after a number
POSE = ("x", "y", "theta")
STATE, COVARIANCE, ELLIPSE = "state", "covariance", "ellipse"
OF_A_BELIEF = (STATE, COVARIANCE, ELLIPSE)  # told again wherever the belief is
LINES = (  # how a line begins, what its numbers are, and their names
    (re.compile(r"Current state estimate is \(x, y, th\) = "), STATE, POSE),
    (re.compile(r"New state estimate is \(x, y, theta\) = "), STATE, POSE),
    (re.compile(r"Revised state estimate: \(x, y, theta\) = "), STATE, POSE),
    (re.compile(r"The predicted range was "), "predicted range", ("",)),
    (re.compile(r"  dh/dx = "), "derivative", ("dh/dx", "dh/dy", "dh/dth")),
    (re.compile(r"C_v is "), "C_v", ("",)),
    (re.compile(r"S is "), "S", ("",)),
    (re.compile(r"The innovation is "), "innovation", ("", "standard deviation", "NIS")),
    (re.compile(r"The Kalman gain is \(x, y, th\) = "), "gain", POSE),
    (re.compile(r"  minor radius is "), ELLIPSE, ("minor radius",)),
    (re.compile(r"  major radius is "), ELLIPSE, ("major radius",)),
    (re.compile(r"  orientation is "), ELLIPSE, ("orientation",)),
    (re.compile(r"  [\d.]+\*sigma_theta is "), ELLIPSE, ("cone",)),
)
MATRICES = {
    "New state covariance matrix is:": COVARIANCE,
    "Revised covariance matrix is:": COVARIANCE,
    **{f"{name} is:": name for name in ("P_u", "J_x", "J_u", "J_u P_u J_u'", "J_x P J_x'")},
}
CONSTANT = {"J_x": ("0", "1"), "J_u": ("0", "1")}  # entries that are so whatever was measured
ROUND = 0.9  # minor radius over major: of a rounder ellipse the orientation says nothing
SHARE = 0.01  # of what a number is small beside: so near an answer must come


class Number(NamedTuple):
    """A number that can be calculated, and wherever it is told it is this one."""

    since: int  # the command at which it is first told
    what: str
    name: str


@dataclass(frozen=True, slots=True)
class Told:
    """A number as it stands in a narrative."""

    text: str
    number: Number | None = None  # None where it is given
    within: float = 0.0  # how near an answer must come, in the unit in which it is told


Line = tuple[str | Told, ...]  # of a matrix its entries, each a Told, and nothing between


@dataclass(frozen=True, slots=True)
class Block:
    """What is told at one command."""

    index: int  # of the command, from 1; 0 is the start
    lines: tuple[Line, ...]


def blocks(
    steps: Iterable[Step], scene: Scene, probability: float, explain: bool
) -> Iterator[Block]:
    """The narrative, a command at a time, with the numbers in it that can be calculated."""
    belief, lines = 0, list[Line]()
    for view in views(steps):
        before, index = belief, view.step.entry.index
        if _makes_a_belief(view):
            belief = index
        told = narrate(view, scene, probability, explain).rstrip("\n").split("\n")
        lines += [("",)] if lines else []  # between a beam and what is made of its reading
        lines += _read(told, _Reader(view.step, before, belief, probability))
        if not view.beam:
            yield Block(index, tuple(lines))
            lines = []


def _makes_a_belief(view: View) -> bool:
    """Whether the belief after it is another than the one before."""
    correction = view.step.correction
    if correction is None:
        return isinstance(view.step.entry.given, Control)
    return not view.beam and int(correction.refused) == Refused.NOT


@dataclass(frozen=True, slots=True)
class _Reader:
    """Reads the numbers of one view."""

    step: Step
    before: int  # the command that made the belief that it begins with
    belief: int  # and the one that it ends with
    probability: float

    def told(self, line: str, what: str, name: str, text: str, at: tuple[int, ...]) -> Told:
        """A number by its name; one that says nothing is given, and so is the first belief."""
        since = self.step.entry.index
        if what in OF_A_BELIEF:
            since = self.before if line.startswith("Current") else self.belief
        if since == 0 or text == "0" or text in CONSTANT.get(what, ()):
            return Told(text)
        within = tolerance(self.step, what, name, at, float(text), self.probability)
        return Told(text, Number(since, what, name), within) if within else Told(text)


def _read(lines: list[str], reader: _Reader) -> Iterator[Line]:
    matrix, row = "", 0
    for line in lines:
        body = line.split(ORIGIN)[0]
        if matrix and line.startswith("["):
            yield tuple(_row(line, matrix, row, reader))
            row += 1
            continue
        matrix, row = MATRICES.get(body, ""), 0
        for begins, what, names in LINES:
            if found := begins.match(body):
                yield tuple(_numbers(line, found.end(), len(body), what, names, reader))
                break
        else:
            yield (line,)


def _numbers(
    line: str, begin: int, end: int, what: str, names: tuple[str, ...], reader: _Reader
) -> Iterator[str | Told]:
    at = 0
    for i, (found, name) in enumerate(zip(NUMBER.finditer(line, begin, end), names, strict=False)):
        yield line[at : found.start()]
        yield reader.told(line, what, name, found[0], (i,))
        at = found.end()
    yield line[at:]


def _row(line: str, what: str, row: int, reader: _Reader) -> Iterator[Told]:
    for column, text in enumerate(NUMBER.findall(line)):
        i, j = (row, column) if what in CONSTANT else sorted((row, column))
        yield reader.told(line, what, f"row {i + 1}, column {j + 1}", text, (i, j))


def tolerance(
    step: Step, what: str, name: str, at: tuple[int, ...], value: float, probability: float
) -> float:
    """How near an answer must come: a hundredth of what the number is small beside, which is its
    standard deviation where it has one. 0 where no answer is to be asked for.
    """
    P = step.posterior.covariance
    σ = np.sqrt(np.diagonal(P))
    c = step.correction
    match what:
        case "state":
            return max(SHARE * _told(σ, at[0]), 1e-4)
        case "covariance" | "J_u P_u J_u'" | "J_x P J_x'":
            return float(SHARE * σ[at[0]] * σ[at[1]]) or SHARE * abs(value)
        case "ellipse":
            drawn = ellipse(P, probability)
            if name == "orientation":
                return 1.0 if drawn.minor < ROUND * drawn.major else 0.0
            return SHARE * abs(value) if name == "cone" else SHARE * float(drawn.major)
    if c is None:  # P_u; J_x and J_u, whose sines and cosines are small beside 1
        return max(SHARE * abs(value), 1e-4 if what in CONSTANT else 0.0)
    sd = math.sqrt(float(c.S[0, 0]))
    match what, name:
        case ("predicted range", _) | ("innovation", ""):
            return max(SHARE * sd, 1e-4)
        case "innovation", "NIS":
            return 2 * SHARE * (math.sqrt(value) + value) + SHARE**2
        case "derivative", _:
            return _largest(c.H)
        case "gain", _:
            return _largest(c.K)
    return SHARE * abs(value)


def _told(σ: Array, i: int) -> float:
    return float(np.degrees(σ[i])) if i == len(POSE) - 1 else float(σ[i])


def _largest(A: Array) -> float:
    return SHARE * float(np.abs(A).max())

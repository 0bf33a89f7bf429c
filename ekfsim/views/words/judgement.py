"""How a view's belief is to be judged, in one line under a picture, and what to warn of.

NIS 82.1 (99.9 %: 10.8) · NEES 20341 (3 dof, 99.9 %: 16.3) · truth outside ellipse and cone · …
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import NamedTuple

from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.verdict import BAND, LOST, Evidence, Verdict, lost
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Refused
from ekfsim.printable import in_a_line, short
from ekfsim.records import Nees
from ekfsim.scene import Scene
from ekfsim.views.playback.view import View
from ekfsim.views.words.numbers import between, count, figure

COLUMNS = 118  # signs in the line of a picture
NAME = 24  # signs of a filter's name


@dataclass(frozen=True, slots=True)
class Standing:
    """How the belief that a view shows stands beside the truth: what to warn of, and why."""

    nees: Nees | None = None  # None where no truth is known
    outside_ellipse: bool = False  # the true position, of the ellipse that is drawn
    outside_cone: bool = False  # the true heading, of the cone that is drawn
    lost_from: int | None = None  # the step since which the run is lost without a gap
    verdict: Verdict | None = None  # on the whole run, in its last view alone

    @property
    def impossible(self) -> bool:
        """Whether the belief is certain of what is not so."""
        return self.nees is not None and bool(self.nees.impossible)

    @property
    def lost(self) -> bool:
        """Whether the run is lost at this view."""
        return self.lost_from is not None

    @property
    def outside(self) -> bool:
        """Whether the truth lies outside what is drawn, be it ellipse or cone."""
        return self.outside_ellipse or self.outside_cone

    @property
    def warns(self) -> bool:
        """Whether there is anything to warn of."""
        condemned = self.verdict is Verdict.OVER_CONFIDENT
        return self.outside or self.lost or self.impossible or condemned


def standing(view: View, probability: float) -> Standing:
    """Of the belief that the view shows. probability : of the ellipse and the cone"""
    truth, judged = view.step.entry.truth, view.judged
    verdict = None if judged.closing is None else judged.closing.verdict
    if view.unplaced:
        truth = None  # nothing is drawn that it could lie outside of
    return Standing(
        judged.nees,
        truth is not None and not inside_ellipse(view.pose, truth, probability),
        truth is not None and not inside_cone(view.pose, truth, probability),
        judged.lost_from,
        verdict,
    )


def warns(view: View, probability: float) -> bool:
    """Whether there is anything to warn of, of one of the filters that watch."""
    return any(standing(one, probability).warns for one in (view, *view.others))


def judgement(view: View, scene: Scene, probability: float, columns: int = COLUMNS) -> str:
    """How the belief of a view is to be judged, in the fullest form that a line has room for.

    It may be empty, where nothing is known. Of the last view of a run it is the verdict. Where
    several filters watch, each has its own.
    """
    every = (view, *view.others)
    forms: Iterator[str]
    if len(every) == 1:
        parts = _parts(view, probability)
        forms = chain(_shorter(parts), _fewer(parts, 0 if view.judged.closing else -1))
    else:
        each = (
            _forms(one, name, probability) for one, name in zip(every, scene.watching, strict=True)
        )
        forms = (" · ".join(form) for form in zip(*each, strict=True))
    told = ""
    for told in forms:
        if len(told) <= columns:
            return told
    return told[: columns - 1].rstrip() + "…"


class Part(NamedTuple):
    """A part of the line, in four forms, one shorter than the other; empty where it is left out."""

    full: str
    fair: str
    small: str
    least: str


FORMS = range(len(Part._fields))


def _shorter(parts: Sequence[Part]) -> Iterator[str]:
    """The whole line, shorter from one to the next: the last of its parts gives way first."""
    taken = [0] * len(parts)
    for form in FORMS:
        for i in reversed(range(len(parts))):
            taken[i] = form
            yield " · ".join(
                word for part, j in zip(parts, taken, strict=True) if (word := part[j])
            )


def _fewer(parts: Sequence[Part], kept: int) -> Iterator[str]:
    """The shortest forms of ever fewer parts, the one that says most to the last."""
    left = list(parts)
    while len(left) > 1:
        del left[-1 if kept == 0 else -2]
        yield " · ".join(part.least for part in left if part.least)


def _parts(view: View, probability: float) -> list[Part]:
    """What is said of one filter by itself, in its order."""
    stands, evidence = standing(view, probability), view.judged.closing
    if evidence is None:
        told = [_nis(view), _nees(stands), _sides(view, stands), _lost(stands)]
        if view.unplaced:
            told = [_nis(view), Part(*("no idea yet where it is",) * 2, *("no idea yet",) * 2)]
    else:
        told = [_verdict(evidence), _nees(_last(stands, evidence)), _sides(view, stands)]
    return [part for part in told if part is not None]


def _nis(view: View) -> Part | None:
    """What a reading was worth, or why it was worth nothing."""
    correction = view.step.correction
    if correction is None:
        return None
    refused = Refused(int(correction.refused))
    nis, dof = float(correction.nis), len(correction.innovation)
    if math.isnan(nis):
        return None
    bound, value = figure(quantile(LOST, dof)), figure(nis)
    unused = ", not used" if refused else ""
    read = f"{dof} dof, " if dof > 1 else ""
    surprising = nis > quantile(LOST, dof)
    return Part(
        f"NIS {value} ({read}{_percent(LOST)}: {bound}){unused}",
        f"NIS {value} ({bound}){unused}",
        f"NIS {value} ({bound})",
        f"NIS {value}" if surprising else "",
    )


def _nees(stands: Standing) -> Part | None:
    nees = stands.nees
    if nees is None:
        return None
    if nees.impossible:
        return Part(
            "belief impossible: certain of what is not so",
            "belief impossible: certain of what is not so",
            "belief impossible",
            "impossible",
        )
    dof = int(nees.dof)
    if dof == 0:
        told = "nothing is uncertain, and the estimate is right"
        return Part(told, told, "certain, and right", "certain")
    bound, value = figure(quantile(LOST, dof)), figure(float(nees.value))
    alone, bounded = f"NEES {value}", f"NEES {value} ({bound})"
    return Part(
        f"NEES {value} ({dof} dof, {_percent(LOST)}: {bound})",
        bounded,
        alone if stands.lost else bounded,
        "" if stands.lost else alone,
    )


def _sides(view: View, stands: Standing) -> Part | None:
    """Where the truth is, seen from what is drawn."""
    if view.step.entry.truth is None:
        if view.step.nees is not None or stands.nees is not None:
            return None
        return Part("truth unknown", "truth unknown", "truth unknown", "truth unknown")
    if stands.nees is not None and int(stands.nees.dof) == 0 and not stands.outside:
        return None  # nothing is drawn around an estimate that is certain
    match stands.outside_ellipse, stands.outside_cone:
        case False, False:
            side, small, least = "inside ellipse and cone", "inside both", "inside"
        case True, True:
            side, small, least = "outside ellipse and cone", "outside both", "outside"
        case True, False:
            side, small = "outside ellipse, inside cone", "outside ellipse"
            least = small
        case _:
            side, small = "inside ellipse, outside cone", "outside cone"
            least = small
    return Part(f"truth {side}", f"truth {side}", f"truth {small}", least)


def _lost(stands: Standing) -> Part | None:
    if stands.lost_from is None:
        return None
    told = f"lost since step {stands.lost_from}"
    return Part(told, told, told, told)


def _verdict(evidence: Evidence) -> Part:
    """The word of a run that is over, with its evidence."""
    word = evidence.verdict.value
    match evidence.verdict:
        case Verdict.NO_EVIDENCE:
            return Part(
                f"Verdict: {word}: no reading could be held against a prediction",
                f"Verdict: {word}: no reading had a NIS",
                f"Verdict: {word}",
                word,
            )
        case Verdict.LOST:
            told = f"{word} since step {evidence.lost_from}"
            silent = evidence.nis_dof and evidence.nis_sum <= evidence.nis_band[1]
            hidden = ", and NIS does not show it" if silent else ""
            return Part(
                f"Verdict: {told}{hidden}", f"Verdict: {told}{hidden}", f"Verdict: {told}", told
            )
    band = between(*evidence.nis_band)
    if evidence.verdict is Verdict.OVER_CONFIDENT:
        word += f" since step {evidence.nis_outside_from}"
    side = {Verdict.OVER_CONFIDENT: "above", Verdict.OVER_CAUTIOUS: "below"}
    where = side.get(evidence.verdict, "within")
    total, readings = figure(evidence.nis_sum), count(evidence.nis_readings, "reading")
    refused = f" ({evidence.nis_refused} refused)" if evidence.nis_refused else ""
    return Part(
        f"Verdict: {word}: ΣNIS {total} of {readings}{refused}, {where} its {_percent(BAND)} band "
        f"{band}",
        f"Verdict: {word}: ΣNIS {total}{refused} {where} {band}",
        f"{word}: ΣNIS {total} {where} {band}",
        word,
    )


def _forms(view: View, name: str, probability: float) -> list[str]:
    """What is said of one filter of several, its name first, in each of the forms."""
    called = in_a_line(short(name, NAME))
    stands, evidence = standing(view, probability), view.judged.closing
    told = [_nees(stands) or _nis(view), _sides(view, stands), _lost(stands)]
    if evidence is not None:
        told = [_verdict(evidence), _sides(view, stands)]
    parts = [part for part in told if part is not None]
    forms = [
        ", ".join(word for part in parts if (word := part[form])).replace("Verdict: ", "")
        for form in FORMS
    ]
    if stands.lost_from is not None:
        shortest = f"lost since {stands.lost_from}"
    elif evidence is not None:
        shortest = evidence.verdict.value
    else:
        shortest = parts[-1].least if parts else ""
    return [f"{called}: {form}" for form in (*forms, shortest)]


def _last(stands: Standing, evidence: Evidence) -> Standing:
    """The same with the last NEES that was known: a recorded truth may end before the run does."""
    return replace(stands, nees=evidence.last_nees)


def fatal(view: View) -> bool:
    """Whether it is this view's own step since which the run is lost."""
    nees, since = view.step.nees, view.judged.lost_from
    return not view.beam and nees is not None and lost(nees) and since == view.step.entry.index


def _percent(probability: float) -> str:
    return f"{100 * probability:.4g} %"

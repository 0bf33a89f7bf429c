"""What is told of a recorded log: what is surprising in it, and what the readings speak for."""

from collections.abc import Iterator, Sequence

import numpy as np

from ekfsim.diagnostics.innovations import Found, Innovations, named
from ekfsim.diagnostics.verdict import BAND, Evidence
from ekfsim.records import Reading, Step
from ekfsim.views.why.changes import all_of
from ekfsim.views.why.driven import CLAUSES
from ekfsim.views.words.numbers import count, figure
from ekfsim.why.records import Explanation, Mechanism

MORE = 1.5  # times the NIS of all: a target that surprises so much is told
NOT_WHITE = "not white"
FEW = 5  # readings; of fewer nothing is told


def of_log(explanation: Explanation) -> Iterator[str]:
    """The sentences, each without its full stop."""
    evidence = Evidence()
    for step in explanation.lost_steps:
        evidence.add(step)
    yield _outcome(explanation, evidence)
    sound = explanation.outcome in ("consistent", "recorded")
    if not sound and explanation.outcome != "over-cautious":
        yield from _surprising(explanation, evidence)
    was = _whiteness(explanation.lost_steps)
    if was.word == NOT_WHITE:
        yield f"The innovations are not white (p {float(was.p):.2g})"
    if sound:
        return
    causes = explanation.causes or (
        () if explanation.mechanism is None else (explanation.mechanism,)
    )
    for cause in causes:
        yield _because(cause)
    yield from _cured(explanation)
    now = _whiteness(explanation.cured_steps)
    if explanation.cure and was.word == NOT_WHITE and now.word != "no evidence":
        word = "are not white with it, either" if now.word == NOT_WHITE else "are white with it"
        yield f"The innovations {word} (p {float(now.p):.2g})"
    if explanation.cure and not causes:
        yield "Other guesses fit as well, or more is wrong than that: no cause is named"


def _whiteness(steps: Sequence[Step]) -> Found:
    innovations = Innovations()
    for step in steps:
        innovations.add(step)
    return innovations.found()


def _outcome(explanation: Explanation, evidence: Evidence) -> str:
    if not evidence.nis_dof:
        return "No reading of this log tells anything of its filter"
    low, high = evidence.nis_band
    known = evidence.last_nees is not None
    begins = "A recorded log" if known else "A recorded log, whose truth is not known"
    if explanation.outcome == "lost":
        begins += f": lost since step {explanation.lost_from}"
    word = "above" if evidence.nis_sum > high else "below" if evidence.nis_sum < low else "within"
    told = (
        f"{begins}: the NIS of {count(evidence.nis_readings, 'reading')} sums to "
        f"{evidence.nis_sum:.6g}, {word} its {100 * BAND:g} % band {low:.6g} to {high:.6g}"
    )
    return told + ": nothing to explain" * (explanation.outcome == "consistent")


def _surprising(explanation: Explanation, evidence: Evidence) -> Iterator[str]:
    """Which target surprises most, where it does so far more than the others."""
    sums: dict[str, tuple[float, int, int]] = {}
    for step in explanation.lost_steps:
        if step.correction is None or not isinstance(step.entry.given, Reading):
            continue
        if np.isnan(nis := float(step.correction.nis)):
            continue
        _, target = named(step.entry.given)
        total, dof, often = sums.get(target, (0.0, 0, 0))
        sums[target] = (total + nis, dof + step.correction.innovation.shape[-1], often + 1)
    often_read = {name: one for name, one in sums.items() if one[2] >= FEW}
    if len(often_read) < 2:
        return
    name, (total, dof, often) = max(often_read.items(), key=lambda one: one[1][0] / one[1][1])
    rest = (evidence.nis_sum - total) / max(evidence.nis_dof - dof, 1)
    if total / dof < MORE * rest:
        return
    yield (
        f"Most surprising is {name}: {figure(total / dof)} per number in {often} readings, "
        f"{figure(rest)} in all others"
    )


def _because(cause: Mechanism) -> str:
    clause = CLAUSES.get(cause, f"What there is of it: {cause.value}")
    return f"What the readings speak for: {clause[:1].lower()}{clause[1:]}"


def _cured(explanation: Explanation) -> Iterator[str]:
    cure, tried = explanation.cure, explanation.tried
    if not cure:
        spent = explanation.replays >= explanation.budget > 0
        more = ", and the budget of replays is spent" if spent else ""
        yield f"Not one of the {count(len(tried), 'change')} that were tried makes it fit{more}"
        return
    ends = next((one.outcome for one in tried if one.change == cure[0]), "consistent")
    alone = "" if len(cure) == 1 else "only together: "
    ended = "it ends consistent" if len(cure) > 1 or ends == "consistent" else f"it ends {ends}"
    yield _begun(f"{alone}{all_of(cure)} {ended}")


def _begun(text: str) -> str:
    return text[:1].upper() + text[1:]

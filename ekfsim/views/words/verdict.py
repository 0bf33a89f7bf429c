"""The verdict on a run in words, with its evidence: whether to believe the filter, and since when
not.
"""

from ekfsim.diagnostics.shutting_out import Weighing
from ekfsim.diagnostics.verdict import BAND, LOST, Evidence, Verdict
from ekfsim.filters.arithmetic.chi_square import band, quantile
from ekfsim.records import Nees
from ekfsim.scene import Scene
from ekfsim.views.playback.view import View
from ekfsim.views.words.narrative.trust import shut_briefly
from ekfsim.views.words.numbers import between, count, figure, number


def sentence(evidence: Evidence) -> str:
    """The verdict on one run and its evidence."""
    verdict = evidence.verdict
    match verdict:
        case Verdict.LOST:
            assert evidence.last_nees is not None
            return (
                f"{verdict.value} from step {evidence.lost_from} on: "
                f"at the last step {_nees(evidence.last_nees)}"
            )
        case Verdict.NO_EVIDENCE:
            return f"{verdict.value}: not one reading could be held against a prediction"
        case Verdict.CONSISTENT:
            return f"{verdict.value}: {_nis(evidence, 'within')}{_also(evidence)}"
        case Verdict.OVER_CONFIDENT:
            return (
                f"{verdict.value}: {_nis(evidence, 'above')}: "
                "the filter trusts itself more than its readings allow"
            )
        case Verdict.OVER_CAUTIOUS:
            return (
                f"{verdict.value}: {_nis(evidence, 'below')}: "
                "the filter trusts itself less than it could"
            )


def meaning(view: View, scene: Scene) -> str:
    """What the verdict on the run comes to, in its last view: whether to believe the filter, and
    since when not. Nothing in any other, nor where several filters watch.
    """
    evidence = view.judged.closing
    if evidence is None or view.others:
        return ""
    match evidence.verdict:
        case Verdict.LOST:
            since = f"lost since step {evidence.lost_from}"
            shut = evidence.trusts.shut_out(Weighing.of(scene))
            if shut is not None:
                return f"not to be believed: {since}; {shut_briefly(shut)}"
            return f"not to be believed: {since}{_shown(evidence)}"
        case Verdict.OVER_CONFIDENT:
            return _but_for_refused(evidence) or (
                f"not to be believed since step {evidence.nis_outside_from}: "
                "it trusts itself more than its readings allow"
            )
        case Verdict.OVER_CAUTIOUS:
            return (
                "to be believed, and nearer to the truth than it says: "
                "it trusts itself less than it could"
            )
        case Verdict.CONSISTENT:
            errors = "" if evidence.last_nees is None else " or its last error"
            return f"to be believed: nothing in its readings{errors} speaks against it"
    return ""


def _shown(evidence: Evidence) -> str:
    """Whether the readings of a run that is lost show it; nothing where there were none."""
    if not evidence.nis_dof:
        return ""
    low, high = evidence.nis_band
    side = "above" if evidence.nis_sum > high else "below" if evidence.nis_sum < low else "within"
    told = (
        f"(ΣNIS {figure(evidence.nis_sum)} of {evidence.nis_readings}, {side} {between(low, high)})"
    )
    if side == "above":
        return f"; its readings say so since step {evidence.nis_outside_from} {told}"
    return f", though its readings do not say so {told}"


def _but_for_refused(evidence: Evidence) -> str:
    """That only readings which were refused speak against a filter, where it is so."""
    low, high = band(BAND, evidence.used_dof)
    if not evidence.nis_refused or evidence.used_sum > high:
        return ""
    side = "below" if evidence.used_sum < low else "within"
    used = count(evidence.nis_readings - evidence.nis_refused, "reading")
    return (
        f"to be believed but for what it refused: ΣNIS of the {used} that it used is "
        f"{figure(evidence.used_sum)}, {side} {between(low, high)}"
    )


def _nis(evidence: Evidence, side: str) -> str:
    low, high = evidence.nis_band
    refused = f" ({evidence.nis_refused} of them refused)" if evidence.nis_refused else ""
    readings = (
        "1 reading is"
        if evidence.nis_readings == 1
        else f"{evidence.nis_readings} readings{refused} sums to"
    )
    mean = (
        ""
        if evidence.nis_dof == 1
        else f" ({evidence.nis_sum / evidence.nis_dof:.3g} per number read)"
    )
    freedom = (
        ""
        if evidence.nis_dof == evidence.nis_readings
        else f" ({count(evidence.nis_dof, 'degree')} of freedom)"
    )
    return (
        f"the NIS of {readings} {number(evidence.nis_sum)}{mean}, {side} the {100 * BAND:.0f} % "
        f"band "
        f"{number(low)} to {number(high)}{freedom}"
    )


def _also(evidence: Evidence) -> str:
    return "" if evidence.last_nees is None else f"; at the last step {_nees(evidence.last_nees)}"


def _nees(measured: Nees) -> str:
    if measured.impossible:
        return (
            "the belief is impossible: the error has a part where the covariance claims certainty"
        )
    dof = int(measured.dof)
    bound = quantile(LOST, dof)
    side = "beyond" if measured.value > bound else "below"
    return (
        f"NEES is {number(float(measured.value))}, {side} its {100 * LOST:.1f} % bound "
        f"{number(bound)} "
        f"({count(dof, 'degree')} of freedom)"
    )

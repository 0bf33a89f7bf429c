"""What was fitted, in words: the numbers with their intervals, and how they do where they were not
fitted.
"""

from ekfsim.diagnostics.verdict import BAND
from ekfsim.filters.arithmetic.chi_square import band
from ekfsim.fitting.estimate import Estimate
from ekfsim.fitting.noises import told_by_readings
from ekfsim.fitting.trial import OUTLIERS, Judged, Trial
from ekfsim.fitting.written import doubts
from ekfsim.printable import in_a_line
from ekfsim.views.words.text_table import aligned, folded
from ekfsim.views.words.whiteness import sentence

OWN = "each reading tells by itself how sure it is, which wins"
HEAD = ("number", "was told", "fitted", "95 % interval", "")


def conclude(trial: Trial, width: int | None = None) -> str:
    """All that is printed when it is over. width : of the terminal; None where there is none"""
    fitted, source = trial.fit, in_a_line(str(trial.scene.log_source))
    lines = [line for told in doubts(trial) for line in (*folded(told, width), "")]
    lines += [
        *folded(f"Fitted to the first half of {source}, by {fitted.trials} runs of the filter "
                "(m, degrees):", width),
        *aligned([HEAD, *map(_row, fitted.found)], 1, width),
    ]  # fmt: skip
    theirs = told_by_readings(trial.scene)
    for one in fitted.idle:
        why = OWN if one.part in theirs else "this log hardly depends on it"
        lines += folded(f"{one.key} is left at {one.in_file(one.value):.4g}: {why}", width)
    for one in fitted.zero:
        lines += folded(f"{one.key} is left at 0: tell a first guess by --set to have it fitted",
                        width)  # fmt: skip
    if fitted.left_out:
        n = len(fitted.left_out)
        gate = trial.scene.gate
        whose = "that the gate refuses" if gate else f"beyond a gate of {OUTLIERS}"
        lines += folded(f"{n} reading{'s' if n > 1 else ''} {whose} told nothing", width)
    lines += ["", *folded("On the second half, which was held back:", width)]
    for name, half in (("as it was told", trial.before), ("as fitted", trial.after)):
        lines += folded(f"  {name}: {nis(half)}; innovations are {sentence(half.found)}", width)
    return "\n".join(lines) + "\n"


def _row(one: Estimate) -> tuple[str, ...]:
    told, value = (one.number.in_file(v) for v in (one.number.value, one.value))
    low, high = (one.number.in_file(v) for v in (one.low, one.high))
    interval = f"{low:.3g} to {high:.3g}" if low > 0 else f"at most {high:.3g}"
    inside = one.low <= one.number.value <= one.high
    return one.number.key, f"{told:.3g}", f"{value:.3g}", interval, "" if inside else "changed"


def nis(half: Judged) -> str:
    """NIS per number read, beside its band."""
    dof = half.evidence.nis_dof
    if not dof:
        return "no reading could be held against a prediction"
    low, high = (end / dof for end in band(BAND, dof))
    side = "above" if half.mean > high else "below" if half.mean < low else "within"
    return (
        f"NIS {half.mean:.3g} per number read, {side} its {100 * BAND:.0f} % band "
        f"{low:.3g} to {high:.3g}"
    )

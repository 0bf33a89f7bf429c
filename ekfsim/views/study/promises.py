"""What became of a scene's promises, a line each."""

import math
from collections.abc import Iterator, Sequence

from ekfsim.printable import in_a_line
from ekfsim.study.expectation import Finding
from ekfsim.study.plan import Plan
from ekfsim.views.study.words import shared

WHAT = {
    "lost": "are lost at the end",
    "coverage": "end inside the 95.4 % ellipse",
    "nis": "have a sum of NIS {} its two-sided 95 % band",
    "nees": "end with a NEES {} its two-sided 95 % bounds",
}


def verify(plan: Plan, findings: Sequence[Finding]) -> str:
    """All that is printed of the promises, each with what was measured and its 95 % interval."""
    return "".join(f"{line}\n" for line in _lines(plan, findings))


def _lines(plan: Plan, findings: Sequence[Finding]) -> Iterator[str]:
    request = plan.request
    yield (
        f"{in_a_line(request.commands_name)}: "
        f"{request.runs} runs of seed {plan.seed}, filter {plan.cases[0].filter}"
    )
    for found in findings:
        yield (
            f"{found.name}: {'kept' if found.kept else 'NOT kept'}: "
            f"{_measured(found)}, {_promise(found)} promised"
        )


def _measured(found: Finding) -> str:
    if math.isnan(found.share.value):
        return "no run ends with an ellipse that has an area"
    return f"{shared(found.share)} of {found.share.of} runs {WHAT[found.name].format(found.side)}"


def _promise(found: Finding) -> str:
    """Where the share is to lie.

    >>> from ekfsim.study.results import Share
    >>> _promise(Finding("lost", Share(1, 2), 0.25, 0.45))
    '25 to 45 %'
    >>> _promise(Finding("nis", Share(1, 2), 0.4, 1.0, "above"))
    'at least 40 %'
    """
    if found.side == "outside":
        return f"fewer than {100 * found.high:.6g} %"
    return (
        f"at least {100 * found.low:.6g} %"
        if found.side
        else f"{100 * found.low:.6g} to {100 * found.high:.6g} %"
    )


def broken(plan: Plan, findings: Sequence[Finding]) -> str:
    """What is said at the end where some are not kept; nothing where all are."""
    many = sum(not found.kept for found in findings)
    return (
        f"{plan.request.commands_name}: {many} of {len(findings)} promises not kept" if many else ""
    )

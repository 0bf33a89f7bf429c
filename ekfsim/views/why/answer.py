"""All that is printed of an explanation: the cause by its name, a sentence with its evidence, what
it rests on, and the table of what was tried.
"""

from collections.abc import Iterator

from ekfsim.diagnostics.shutting_out import shut_out_of
from ekfsim.printable import in_a_line
from ekfsim.views.why.changes import all_of, joined, named, put_right
from ekfsim.views.why.mechanisms import LASER, because, told_noise
from ekfsim.views.why.recorded import of_log
from ekfsim.views.why.tried import table
from ekfsim.views.words.narrative.trust import shutting_out
from ekfsim.views.words.numbers import count
from ekfsim.views.words.text_table import folded
from ekfsim.why.records import Explanation, Mechanism, Shares, Tried

TOLD_OTHERS = 3  # changes that cure as well, which are told by name


def answer(explanation: Explanation, width: int | None = None) -> str:
    """What `ekfsim why` prints. width : of the terminal; None where there is none"""
    scene = explanation.scene
    which = f"{in_a_line(scene.commands_source)}: seed {scene.seed}, run {scene.run}"
    lines = [
        *folded(f"{which}, {', '.join(map(in_a_line, scene.watching[:1]))}", width),
        *folded(f"Cause: {cause(explanation)}", width),
        *folded(sentence(explanation), width),
    ]
    if explanation.tried:
        lines += ["", *folded(effort(explanation), width), *table(explanation, width)]
    return "\n".join(lines) + "\n"


def cause(explanation: Explanation) -> str:
    """What the cause is called.

    >>> from ekfsim import load_scene
    >>> cause(Explanation(load_scene("square"), "consistent", None))
    'nothing to explain'
    """
    if explanation.mechanism is not None:
        return explanation.mechanism.value
    if explanation.causes:
        return f"more than one: {joined([one.value for one in explanation.causes])}"
    if explanation.outcome == "consistent":
        return "nothing to explain"
    return "not found"


def sentence(explanation: Explanation) -> str:
    """Why the run ended as it did, with the evidence, in plain sentences."""
    if explanation.scene.log is not None:
        return " ".join(f"{one}." for one in of_log(explanation))
    return " ".join(f"{one}." for one in _sentences(explanation))


def _sentences(explanation: Explanation) -> Iterator[str]:
    if explanation.outcome == "consistent":
        yield from _consistent(explanation)
        return
    yield _outcome(explanation)
    mechanism = explanation.mechanism
    if explanation.causes:
        yield from (because(explanation, one) for one in explanation.causes)
    elif mechanism is not None and not _said_already(explanation):
        yield because(explanation, mechanism)
    if (shut := shut_out_of(explanation.lost_steps, explanation.scene)) is not None:
        yield begun(shutting_out(shut, explanation.outcome == "lost"))
    yield from _cured(explanation)
    if explanation.parts_at is not None and explanation.cure:
        yield f"The two estimates part at step {explanation.parts_at}"
    if explanation.stopped:
        yield "Ctrl-C came before many runs had been asked, so no cause is named"
    if explanation.shares is not None:
        together = "with all of these put right" if explanation.causes else None
        yield shares(explanation.shares, together)


def _consistent(explanation: Explanation) -> Iterator[str]:
    yield "The run ends consistent: nothing to explain"
    if explanation.mechanism is not None:
        yield because(explanation, explanation.mechanism)


def _outcome(explanation: Explanation) -> str:
    """How the run ended."""
    match explanation.outcome:
        case "lost":
            since = explanation.lost_from
            return "Lost" if since is None else f"Lost since step {since}"
        case "recorded":
            return "A recorded log: what was true is not known"
    if _said_already(explanation) and explanation.mechanism is not None:
        noise = told_noise(explanation.scene, explanation.mechanism)
        return f"{begun(explanation.outcome)}, not lost: told {noise}"
    return f"{begun(explanation.outcome)}, not lost"


def _said_already(explanation: Explanation) -> bool:
    """Whether what it ended as is told with the cause."""
    noises = (*LASER, Mechanism.ODOMETRY_OVERTRUSTED, Mechanism.ODOMETRY_DISTRUSTED)
    return (
        explanation.outcome in ("over-cautious", "over-confident")
        and explanation.mechanism in noises
        and explanation.scene.commanded
    )


def _cured(explanation: Explanation) -> Iterator[str]:
    """What cures it, and what does not."""
    cure, tried = explanation.cure, explanation.tried
    if not tried:
        yield "There is nothing that could be put right"
        return
    if explanation.outcome == "recorded" and not cure:
        return
    if not cure:
        spent = explanation.replays >= explanation.budget > 0
        yield f"Not one of the {count(len(tried), 'change')} that were tried cures it" + (
            ", and the budget of replays is spent: a larger --budget may tell" if spent else ""
        )
        return
    if len(cure) > 1:
        yield f"Only together they cure it: {all_of(cure)} the run ends consistent"
        return
    alone = next((one for one in tried if one.change == cure[0]), None)
    yield f"{begun(put_right(cure[0]))} the run {_ending(alone)}"
    others, also = len(tried) - 1, explanation.others
    if not also:
        if others > 0:
            yield f"{'None of the' if others > 1 else 'The'} {count(others, 'other change')} " + (
                "cures it" if others > 1 else "does not cure it"
            )
        return
    names = [named(one) for one in also[:TOLD_OTHERS]]
    more = len(also) - len(names)
    listed = joined([*names, f"{more} more"] if more > 0 else names)
    verb = "cures" if len(also) == 1 else "cure"
    yield f"Of the {count(others, 'other change')} {len(also)} {verb} it as well: {listed}"


def begun(clause: str) -> str:
    """A clause that begins a sentence; names in it stay as they are."""
    return clause[:1].upper() + clause[1:]


def _ending(alone: Tried | None) -> str:
    if alone is None or alone.outcome == "consistent":
        return "ends consistent"
    return f"is no longer lost, but {alone.outcome}"


def shares(found: Shares, deed: str | None = None) -> str:
    """What many runs say: as they stand, and with such a change. deed : in its words, where not in
    those of the change
    """
    low, high = sorted(100 * edge for edge in (found.low, found.high))
    what = found.of
    if found.change is None:
        return (
            f"Of {found.runs} runs {percent(found.lost)} are {what} [{low:.1f} to {high:.1f} %], "
            "no more than that"
        )
    change = 100 * (found.lost_with - found.lost)
    numbers = f"{change:+.1f} points, {low:+.1f} to {high:+.1f}".replace("-", "−")
    return (
        f"Of {found.runs} runs {percent(found.lost)} are {what} as they stand, "
        f"{percent(found.lost_with)} {deed or put_right(found.change)} [{numbers}]"
    )


def percent(share: float) -> str:
    """A share as people say it.

    >>> percent(0.378), percent(0.0052), percent(0.0)
    ('38 %', '0.5 %', '0 %')
    """
    value = 100 * share
    return f"{value:.0f} %" if value >= 10 or value == 0 else f"{value:.1f} %"


def effort(explanation: Explanation) -> str:
    """How much was tried."""
    cured = sum(one.cures for one in explanation.tried)
    return (
        f"{count(len(explanation.tried), 'change')} tried on the same draws, each alone: "
        f"{cured} {'cures' if cured == 1 else 'cure'}; {explanation.replays} of at most "
        f"{count(explanation.budget, 'replay')}"
        + (", which did not do for all" if explanation.replays >= explanation.budget else "")
        + (", then Ctrl-C" if explanation.stopped else "")
    )

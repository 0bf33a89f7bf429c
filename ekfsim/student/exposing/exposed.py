"""The first step at which a filter with a known mistake has other numbers than the right one."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from ekfsim.commands import Command, Move, Sense
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.tuning import UNTUNED
from ekfsim.localization import filter_of, play
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.student.asked import Asked
from ekfsim.student.comparing.compare import Compared, answered
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.mutant import Mutant


@dataclass(frozen=True, slots=True)
class Exposed:
    """What a scene shows of a mistake."""

    mistake: Mistake
    possible: bool  # whether it can be made with this robot in this world
    first: Compared | None  # the first step at which it shows; None where it never does


def exposed(scene: Scene, mistakes: Sequence[Mistake] = KNOWN) -> tuple[Exposed, ...]:
    """What a scene's run shows of each mistake, which is compared with the EKF.

    Until it shows, a filter with the mistake believes what the EKF does: one run of that serves
    for them all.
    """
    played = of_the_textbook(scene)
    reference = filter_of(played)
    can_be_made = possible(played, mistakes)
    found = {mistake: Exposed(mistake, mistake in can_be_made, None) for mistake in mistakes}
    for step, asked in handed_over(play(played)):
        left = [one for one in found.values() if one.first is None and one.mistake.where(asked)]
        for one in left:
            told = answered(asked, Mutant(one.mistake), reference, step.layout, played.guard)
            shows = told if told is not None and told.differences else None
            found[one.mistake] = Exposed(one.mistake, True, shows)
        if all(one.first is not None for one in found.values()):
            break
    return tuple(found.values())


# in a world with walls all round: every kind of step, and each reading with others before it
EVERY_STEP: tuple[Command, ...] = (
    *(Move(0.1, 0.1), Sense(0.0), Sense(math.pi / 2)),
    *(Move(0.1, 0.1), Sense(math.pi), Sense(-math.pi / 2)),
)


def possible(scene: Scene, mistakes: Iterable[Mistake]) -> set[Mistake]:
    """The mistakes that can be made with a scene's robot in its world, whatever it does there."""
    probe = replace(scene, commands=EVERY_STEP) if scene.commanded else scene
    left, found = set(mistakes), set[Mistake]()
    for _, asked in handed_over(play(probe)):
        found |= {mistake for mistake in left if mistake.where(asked)}
        left -= found
    return found


def of_the_textbook(scene: Scene) -> Scene:
    """The same scene, watched by the EKF as the textbook has it."""
    return replace(scene, filter="ekf", beside=(), tuning=UNTUNED)


def handed_over(steps: Iterable[Step]) -> Iterator[tuple[Step, Asked]]:
    """The steps in which a filter is asked something, and what."""
    earlier: Asked | None = None
    for step in steps:
        given, c = step.entry.given, step.correction
        if given is None or (c is not None and not c.used):
            continue
        asked = Asked.at(step.entry, Gaussian(*step.prior), step.layout.headings, earlier)
        yield step, asked
        earlier = asked.as_earlier()

"""The table and the guess, each mistake made by its own mutant."""

from itertools import islice

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.geometry.angles import wrap
from ekfsim.localization import play
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.guessing import guesses
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mutant import Mutant
from ekfsim.student.mistakes.working import right

ELSEWHERE = {  # mistakes that the tour cannot show
    "no-process-noise": "mower",
    "K-entry-by-entry": "landmarks",
    "wall-by-reading": "diverge-06b-pillar-corridor",
}
SCENES = ("tour", "proof-two-beams", "proof-unsure-start")


def calls(name):
    """Every call of a run of the EKF, with what it answered."""
    earlier = None
    scene = load_scene(name)
    for step in play(scene):
        if step.entry.given is None:
            continue
        entry = step.entry
        earlier = Asked(
            *step.prior, entry.given, scene.world.layout.headings, entry.command, entry.index,
            earlier,
        )  # fmt: skip
        yield earlier, step.posterior


@pytest.mark.parametrize("name", SCENES)
def test_the_working_of_a_step_is_the_ekf_s(name):
    for asked, belief in calls(name):
        x, P = right(asked)
        assert x == pytest.approx(belief.mean, abs=1e-12)
        assert pytest.approx(belief.covariance, abs=1e-12) == P


def test_no_two_mistakes_have_one_name():
    assert len({mistake.name for mistake in KNOWN}) == len(KNOWN)


@pytest.mark.parametrize(
    "mistake",
    [m for m in KNOWN if m.name != "innovation-not-wrapped"],
    ids=lambda mistake: mistake.name,
)
def test_a_mutant_is_named_where_it_shows(mistake):
    shown = list(islice(differing(mistake), 1))
    assert shown
    for asked, theirs, unit in shown:
        assert (mistake,) in guesses(asked, theirs, unit)


def test_any_two_mistakes_can_be_made_together_and_nothing_else_is_named():
    entries = list(calls("tour"))
    for asked, belief in (entries[9], entries[11]):
        x, P = belief
        assert guesses(asked, Answer(x + 0.001, P), deviations(P)) == []
        assert guesses(asked, Answer(x, P + 0.1 * P.min()), deviations(P)) == []


def deviations(P):
    return np.maximum(np.sqrt(np.diag(P)), 1e-6)


def differing(mistake):
    """The calls at which a filter with this mistake has other numbers than the EKF."""
    for asked, belief in calls(ELSEWHERE.get(mistake.name, "tour")):
        x, P = Mutant(mistake).call(asked)
        unit = deviations(belief.covariance)
        apart = np.abs(P - belief.covariance) / np.outer(unit, unit)
        if max(apart.max(), np.max(np.abs(wrap(x - belief.mean)) / unit)) > 1e-6:
            yield asked, Answer(np.array(x), np.array(P)), unit

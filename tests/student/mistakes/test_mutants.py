"""The table and the guess, each mistake made by its own mutant."""

from itertools import islice

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.localization import play
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.guessing import guesses
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mutant import mutant
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
    shown = 0
    for asked, belief in islice(calls(ELSEWHERE.get(mistake.name, "tour")), 60):
        theirs = mutant(mistake).call(asked)
        unit = np.maximum(np.sqrt(np.diag(belief.covariance)), 1e-6)
        apart = np.abs(theirs.P - belief.covariance) / np.outer(unit, unit)
        if max(apart.max(), np.max(np.abs(theirs.x - belief.mean) / unit)) < 1e-6:
            continue
        shown += 1
        assert (mistake,) in guesses(asked, Answer(*map(np.array, theirs)), unit)
    assert shown

"""What is handed out per step stays as it is: nobody can write into it, and going on changes
nothing."""

import copy
import dataclasses

import numpy as np
import pytest

import ekfsim
from ekfsim import localization
from ekfsim.records import Entry

SQUARE = ekfsim.load_scene("square")
RUNS = (
    SQUARE, SQUARE.with_(filter="pf").with_("filter.particles", 20), SQUARE.with_(filter="iekf"),
    ekfsim.load_scene("pioneer"),
)  # fmt: skip


def arrays(one):
    """Every array of a step, those of its models and of what they remark among them."""
    if isinstance(one, np.ndarray):
        yield one
    elif isinstance(one, tuple):
        for part in one:
            yield from arrays(part)
    elif dataclasses.is_dataclass(one):
        left_out = {"scene", "layout", "command"}
        for field in dataclasses.fields(one):
            if field.name not in left_out:
                yield from arrays(getattr(one, field.name))


def some(steps, n=40):
    return [step for step, _ in zip(steps, range(n), strict=False)]


@pytest.mark.parametrize("scene", RUNS, ids=lambda scene: f"{scene.filter} {scene.world.system}")
def test_all_that_is_kept_stays_and_nobody_can_write_into_it(scene):
    coming, kept, printed = ekfsim.play(scene), [], []
    for step in coming:
        for array in arrays(step):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 7
        kept.append(step)
        printed.append(copy.deepcopy([*arrays(step)]))
        if len(kept) == 40:
            break
    for step, before in zip(kept, printed, strict=True):
        assert all(map(np.array_equal, arrays(step), before, [True] * len(before)))
    inside = some(localization.play(scene))
    for ours, theirs in zip(kept, inside, strict=True):
        assert np.array_equal(ours.posterior.mean, theirs.posterior.mean)


def test_a_step_knows_its_scene():
    assert all(step.scene is SQUARE for step in ekfsim.play(SQUARE))


def test_inside_the_program_nothing_is_held_and_no_scene_is_kept():
    step = [*localization.play(SQUARE)][-1]
    assert step.scene is None
    assert step.posterior.mean.flags.writeable


def test_entries_are_held_but_not_those_that_one_hands_over():
    entries = [*ekfsim.simulate(SQUARE)]
    given = entries[1].given
    with pytest.raises(ValueError, match="read-only"):
        given.u[0] = 3
    own = [Entry(entry.index, copy.deepcopy(entry.given)) for entry in entries]
    belief = ekfsim.Gaussian(*map(np.array, ekfsim.first_belief(SQUARE)))
    steps = [*ekfsim.localize(own, ekfsim.filter_of(SQUARE), belief)]
    assert own[1].given.u.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        steps[-1].posterior.mean[0] = 3
    whole = [*ekfsim.play(SQUARE)]
    assert np.array_equal(steps[-1].posterior.mean, whole[-1].posterior.mean)


def test_a_filter_that_writes_into_what_it_is_given_may_go_on():
    def predict(x, P, u, motion):
        F, G = motion.F(x, u), motion.G(x, u)
        x[:] = motion.f(x, u)
        P[...] = F @ P @ F.T + G @ motion.M(u) @ G.T
        return x, P

    def update(x, P, z, sensor):
        z *= 1
        return x, P

    ekfsim.bring(predict, update, name="writer")
    steps = [*ekfsim.play(SQUARE.with_(filter="writer"))]
    assert np.isfinite(steps[-1].posterior.mean).all()


def test_the_first_belief_that_one_hands_over_stays_ones_own():
    belief = ekfsim.Gaussian(*map(np.array, ekfsim.first_belief(SQUARE)))
    steps = ekfsim.localize(ekfsim.simulate(SQUARE), ekfsim.filter_of(SQUARE), belief)
    next(steps)
    belief.mean[:] = belief.mean

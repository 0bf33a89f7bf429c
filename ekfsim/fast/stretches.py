"""Motion inputs that follow one another, with no reading between, taken a stretch at a time."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice, repeat
from typing import TypeVar

import numpy as np

from ekfsim.diagnostics.nees import nees
from ekfsim.fast.many_steps import moved, propagated
from ekfsim.fast.records import records
from ekfsim.filters.belief import Belief, Gaussian, Prediction
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array
from ekfsim.localization import advance
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.protocols import Motion
from ekfsim.records import Control, Entry, Nees, Step
from ekfsim.scene import Guard

T = TypeVar("T")

AHEAD = 64  # entries, and steps, of one run that are made before they are used
FEW = 8  # inputs that are sooner taken one by one
MOST = 256  # inputs at once, of one run
AT_ONCE = 8192  # inputs times runs that stay in the processor's cache
NEAR = 1e-12  # of a way, in m: by how much the Jacobian of the same way may differ from it
UNMOVED = np.eye(3)[:, :2]  # ∂f/∂(x, y) of a robot that moves alike wherever it stands


def localize(
    entries: Iterable[Entry],
    filter: Filter,
    belief: Belief,
    guard: Guard = "warn",
    layout: Layout = POSE,
) -> Iterator[Step] | None:
    """The steps of a filter that predicts as the EKF does; None of another, or of another state."""
    if getattr(type(filter), "predict", None) is not EKF.predict or not layout.is_pose:
        return None
    if belief.mean.ndim > 1:
        return _localized(entries, filter, belief, guard, layout)
    return ahead(_localized(ahead(entries), filter, belief, guard, layout))


def ahead(coming: Iterable[T]) -> Iterator[T]:
    """The same, some made before the first of them is given away: simulating, filtering and telling
    in turns, each drives the other's code and data out of the processor's cache.

    What fails in making one is raised when those before it are given away, as without.
    """
    coming, failed = iter(coming), None
    while True:
        made: list[T] = []
        try:
            for each in islice(coming, AHEAD):
                made.append(each)
        except Exception as error:
            failed = error
        yield from made
        if failed is not None:
            raise failed
        if len(made) < AHEAD:
            return


def _localized(
    entries: Iterable[Entry], filter: Filter, belief: Belief, guard: Guard, layout: Layout
) -> Iterator[Step]:
    most = min(MOST, AT_ONCE // max(belief.mean.size // 3, 1))
    step: Step | None = None
    for together in _gathered(entries, most):
        made = _stretched(belief, together, layout) if len(together) >= FEW else None
        if made is None:
            for entry in together:
                step = _still(step, entry) or advance(filter, belief, entry, guard, layout)
                belief = step.posterior
                yield step
        else:
            step = made[-1]
            belief = step.posterior
            yield from made


def _still(before: Step | None, entry: Entry) -> Step | None:
    """The step of an entry at which nothing happens: its NEES is that of the step before."""
    if before is None or entry.given is not None or entry.truth is not before.entry.truth:
        return None
    belief = before.posterior
    return Step(entry, belief, belief, nees=before.nees, layout=before.layout)


def _gathered(entries: Iterable[Entry], most: int) -> Iterator[list[Entry]]:
    """The entries, those together that are inputs of one motion which nobody commanded."""
    gathered: list[Entry] = []
    motion: Motion | None = None
    for entry in entries:
        given = entry.given
        if not isinstance(given, Control) or entry.command is not None:
            if gathered:
                yield gathered
                gathered = []
            yield [entry]
            continue
        if gathered and (given.motion is not motion or len(gathered) == most):
            yield gathered
            gathered = []
        motion = given.motion
        gathered.append(entry)
    if gathered:
        yield gathered


def _stretched(belief: Belief, entries: list[Entry], layout: Layout) -> list[Step] | None:
    """The steps of inputs of one motion; None where it is no planar odometry."""
    given = entries[0].given
    assert isinstance(given, Control)
    motion = given.motion
    U = np.array([entry.given.u for entry in entries if isinstance(entry.given, Control)])
    mean = moved(belief.mean, motion, U)
    before = np.concatenate([belief.mean[None], mean[:-1]])
    F, G = motion.F(before, U), motion.G(before, U)
    if not is_planar(F, mean - before):
        return None
    after = propagated(belief, mean, G, motion.M(U), motion.Q(U))
    n, nothing = len(entries), repeat(None)
    posteriors = list(map(Gaussian, after.mean, after.covariance))
    predictions = records(Prediction, n, F, G)
    judged = _judged(after, posteriors, entries, layout)
    priors = [belief, *posteriors]
    return records(
        Step, n, entries, priors, posteriors, predictions, nothing, nothing, judged,
        repeat(layout), nothing,
    )  # fmt: skip


def is_planar(F: Array, way: Array) -> bool:
    """Whether F = [1 0 −Δy; 0 1 Δx; 0 0 1], as it is of a robot that moves alike wherever it
    stands : (T, …, 3, 3); way : (T, …, 3)

    Of many runs the first tells it of their common motion.
    """
    F, way = F.reshape(len(F), -1, 3, 3)[:, 0], way.reshape(len(way), -1, 3)[:, 0]
    turned = np.stack([-way[..., 1], way[..., 0]], axis=-1)
    return bool(
        (F[..., :2] == UNMOVED).all()
        and (F[..., 2, 2] == 1).all()
        and np.allclose(F[..., :2, 2], turned, rtol=0, atol=NEAR * (1 + np.abs(way).max()))
    )


def _judged(
    after: Gaussian, posteriors: list[Gaussian], entries: list[Entry], layout: Layout
) -> Sequence[Nees | None]:
    """What `advance` finds of each, where the truth is known."""
    truths = [entry.truth for entry in entries if entry.truth is not None]
    if len(truths) < len(entries) or after.mean.size // 3 < 64:
        return [
            None if entry.truth is None else nees(posterior, entry.truth, layout)
            for posterior, entry in zip(posteriors, entries, strict=True)
        ]
    axes = after.mean.shape[:-1]
    flat = Gaussian(after.mean.reshape(-1, 3), after.covariance.reshape(-1, 3, 3))
    found = nees(flat, np.array(truths).reshape(-1, 3), layout)
    value, dof, impossible = (
        part.reshape(axes) for part in (found.value, found.dof, found.impossible)
    )
    return records(Nees, len(entries), value, dof, impossible)

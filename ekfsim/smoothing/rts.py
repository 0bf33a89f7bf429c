"""Steps → the same Steps, each belief with all readings of the run: Rauch, Tung & Striebel, 1965.

The assumption is the filter's own, for its numbers are taken as they stand: where it was led
astray, so is the smoother, and a robot that was carried away was carried away before, too.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.diagnostics.nees import nees
from ekfsim.errors import StepError
from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.records import Nees, Step
from ekfsim.smoothing.passing import Motions, Passing, noise, passing, slope

TOGETHER = 4096  # steps times runs that are calculated at once


@dataclass(frozen=True, slots=True)
class Kept:
    """What the way back needs of a step; of a crowd of particles that is little."""

    step: Step  # its beliefs with a mean and a covariance alone
    F: Array | None = None  # (…, n, n) of a motion


def smooth(steps: Iterable[Step]) -> list[Step]:
    """The same steps, each with the belief that all readings of the run leave of it: Särkkä,
    Bayesian Filtering and Smoothing, 2013, Theorem 8.2. Arrays carry the leading axes of the steps.

        A = P Fᵀ (P⁻)⁺      xˢ = x + A (xˢ⁺ − x⁻)      Pˢ = P + A (Pˢ⁺ − P⁻) Aᵀ

    over each motion, from the last step back to the start; ˢ⁺ is the smoothed belief after it, and
    x⁻, P⁻ is what the filter itself had predicted. Where nothing moves, at a reading, used or not,
    or where the filter is told nothing, the state is the same before and after, and so is what is
    known of it. A certain state stays what it is.

    Prior and posterior of each are smoothed, and the NEES is that of the posterior; what is told of
    predictions, innovations and refusals stays the filter's own.
    """
    kept = [of_step(step) for step in steps]
    return list(_forth(kept))


def smoothed(steps: Iterable[Step]) -> Iterator[Step]:
    """The same as they are asked for. Of a run that fails, what came before it, and then the
    failure.
    """
    coming = list[Step]()
    try:
        coming.extend(steps)
    except StepError:
        yield from smooth(coming)
        raise
    yield from smooth(coming)


def of_step(step: Step) -> Kept:
    """What is kept of a step until the run is over."""
    prior, posterior = Gaussian(*step.prior), Gaussian(*step.posterior)
    plain = replace(step, prior=prior, posterior=posterior, nees=None)
    return Kept(plain, None if step.prediction is None else slope(step))


def _forth(kept: list[Kept]) -> Iterator[Step]:
    """The smoothed steps, in the order of the run. Of many runs they take the memory, so that each
    step takes the place of what was kept of it: nothing is left in the list.
    """
    if not kept:
        return iter(())
    last = kept[-1].step.posterior
    runs = max(last.mean.size // last.mean.shape[-1], 1)
    portion, made = max(TOGETHER // runs, 1), list[list[Step]]()
    after = Gaussian(*last)
    while kept:
        some = kept[-portion:]
        del kept[-portion:]
        beliefs = _back(some, after)
        made.append(_revised(some, beliefs))
        after = beliefs[0]
    return (step for portion_ in reversed(made) for step in portion_)


def _back(kept: Sequence[Kept], after: Gaussian) -> list[Gaussian]:
    """The smoothed beliefs before the first of some steps, and after each of them, of which the
    last is known.
    """
    passings = iter(_passings(kept))
    beliefs = [after]
    for one in reversed(kept):
        if one.F is not None:
            after = _before(one.step, after, next(passings))
        beliefs.append(after)
    return beliefs[::-1]


def _passings(kept: Sequence[Kept]) -> list[Passing]:
    """Those of the motions among some steps, the last of them first."""
    moved = [
        (one.step.prior.covariance, one.step.posterior.covariance, one.F, noise(one.step, one.F))
        for one in reversed(kept)
        if one.F is not None
    ]
    if not moved:
        return []
    axes = moved[0][1].shape
    together = Motions(
        *(
            np.stack([np.broadcast_to(one, axes) for one in column])
            for column in zip(*moved, strict=True)
        )
    )
    return list(map(Passing, *passing(together)))


def _before(step: Step, after: Gaussian, told: Passing) -> Gaussian:
    """xˢ = x + A (xˢ⁺ − x⁻)      Pˢ = left + A Pˢ⁺ Aᵀ"""
    A, left = told
    headings = step.layout.headings
    learnt = wrapped(after.mean - step.posterior.mean, headings)
    x = wrapped(step.prior.mean + np.matvec(A, learnt), headings)
    return Gaussian(x, symmetric(left + A @ after.covariance @ A.mT))


def _revised(kept: Sequence[Kept], beliefs: Sequence[Gaussian]) -> list[Step]:
    """The steps with their smoothed beliefs, of which there is one more than steps."""
    judged = _judged([one.step for one in kept], beliefs[1:])
    return [
        replace(one.step, prior=before, posterior=after, nees=measured)
        for one, before, after, measured in zip(
            kept, beliefs[:-1], beliefs[1:], judged, strict=True
        )
    ]


def _judged(steps: Sequence[Step], beliefs: Sequence[Gaussian]) -> list[Nees | None]:
    """NEES of the smoothed beliefs, where the truth is known."""
    known = [i for i, step in enumerate(steps) if step.entry.truth is not None]
    found: list[Nees | None] = [None] * len(steps)
    if not known:
        return found
    x = np.stack([beliefs[i].mean for i in known])
    P = np.stack([beliefs[i].covariance for i in known])
    truths = [steps[i].entry.truth for i in known]
    axes = (*x.shape[1:-1], 3)
    truth = np.stack([np.broadcast_to(np.asarray(one), axes) for one in truths])
    all_of = nees(Gaussian(x, P), truth, steps[0].layout)
    for k, i in enumerate(known):
        found[i] = Nees(all_of.value[k], all_of.dof[k], all_of.impossible[k])
    return found

"""Back over a motion: what a belief owes to the one that came of it."""

from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.nees import RANK, ROUNDING
from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.belief import Mixture, Particles
from ekfsim.geometry import Array
from ekfsim.records import Control, Step

SAME = 1e-9  # of the deviations: by how much F P Fᵀ + G M Gᵀ + Q may miss what the filter made


class Motions(NamedTuple):
    """Motions that follow one another, one on each place of the first axis."""

    P: Array  # before each : (k, …, n, n)
    after: Array  # P⁻, what the filter made of it : (k, …, n, n)
    F: Array  # (k, …, n, n)
    noise: Array  # what the motion itself adds, P⁻ = F P Fᵀ + noise : (k, …, n, n)


class Passing(NamedTuple):
    """What the state before a motion is, once the one after it is known."""

    A: Array  # how much of an error after it was there before : (…, n, n)
    left: Array  # the covariance of what the state after it cannot tell : (…, n, n)


def slope(step: Step) -> Array:
    """F : (…, n, n) with P Fᵀ the covariance of the states before and after a motion.

    Every filter tells it: the sigma points' is their statistical linearisation, P_yx P⁺. A crowd
    that was moved, or several hypotheses, each by a slope of its own, know the covariance itself,
    and F is what it makes of that.
    """
    assert step.prediction is not None
    before, after = step.prior, step.posterior
    F = step.prediction.F
    if isinstance(before, Particles) and isinstance(after, Particles):
        if before.states.shape != after.states.shape:
            return F
        return _regression(before.covariance, _of_crowd(before, after, step.layout.headings))
    if isinstance(before, Mixture) and isinstance(after, Mixture) and before.weights.shape[-1] > 1:
        several = before.weights[..., :1, None] < 1  # the heaviest comes first, and F is its own
        made = _regression(before.covariance, _of_mixture(before, after, step))
        return np.where(several, made, F)
    return F


def _of_crowd(before: Particles, after: Particles, headings: tuple[int, ...]) -> Array:
    """P_xy : (…, n, n) of the particles before and after a motion."""
    δ = wrapped(before.states - before.mean[..., None, :], headings)
    δ_after = wrapped(after.states - after.mean[..., None, :], headings)
    return δ.mT @ (before.weights[..., None] * δ_after)


def _of_mixture(before: Mixture, after: Mixture, step: Step) -> Array:
    """P_xy = Σ wᵢ (Pᵢ Fᵢᵀ + (xᵢ − x)(xᵢ⁻ − x⁻)ᵀ) : (…, n, n)"""
    given, headings = step.entry.given, step.layout.headings
    assert isinstance(given, Control)
    F = given.motion.F(before.means, given.u[..., None, :])
    w = before.weights[..., None]
    δ = wrapped(before.means - before.mean[..., None, :], headings)
    δ_after = wrapped(after.means - after.mean[..., None, :], headings)
    each = np.sum(w[..., None] * (before.covariances @ F.mT), axis=-3)
    cross: Array = each + δ.mT @ (w * δ_after)
    return cross


def _regression(P: Array, cross: Array) -> Array:
    """F = P_yx P⁺ : (…, n, n)"""
    F: Array = (inverse_on_range(P) @ cross).mT
    return F


def noise(step: Step, F: Array) -> Array:
    """P⁻ − F P Fᵀ : (…, n, n), what the motion adds.

    From the motion itself, G M Gᵀ + Q, where that is what the filter added: the difference of two
    large covariances keeps no digit of a small one.
    """
    P, after = step.prior.covariance, step.posterior.covariance
    moved = F @ P @ F.mT
    left = symmetric(after - moved)
    given, made = step.entry.given, step.prediction
    assert isinstance(given, Control)
    assert made is not None
    added = made.G @ given.motion.M(given.u) @ made.G.mT + given.motion.Q(given.u)
    σ = np.sqrt(np.maximum(np.diagonal(after, axis1=-2, axis2=-1), 0.0))
    limit = SAME * σ[..., :, None] * σ[..., None, :]
    same = np.all(np.abs(left - added) <= limit, axis=(-2, -1))
    return np.where(same[..., None, None], added, left)


def passing(motions: Motions) -> Passing:
    """A = P Fᵀ (P⁻)⁺      left = (I − A F) P (I − A F)ᵀ + A noise Aᵀ

    The second is P − A P⁻ Aᵀ as a sum of squares, so that what a smoothed belief is left with is
    never less than nothing.
    """
    P, after, F, noise = motions
    A = P @ F.mT @ inverse_on_range(after)
    I_AF = np.eye(P.shape[-1]) - A @ F
    return Passing(A, symmetric(I_AF @ P @ I_AF.mT + A @ noise @ A.mT))


def inverse_on_range(P: Array) -> Array:
    """P⁺ : (…, n, n), an inverse on the range of P, which has the rank that NEES counts: what is
    certain, a state or a direction, is told nothing. nan where P is.
    """
    σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
    σ = np.where(σ > ROUNDING, σ, 0.0)
    per_σ = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    C = P * per_σ[..., :, None] * per_σ[..., None, :]
    known = np.isfinite(C).all(axis=(-2, -1), keepdims=True)
    λ, V = np.linalg.eigh(np.where(known, C, 0.0))
    per_λ = np.divide(1.0, λ, out=np.zeros_like(λ), where=λ > RANK)
    B = per_σ[..., :, None] * V
    return np.where(known, (B * per_λ[..., None, :]) @ B.mT, np.nan)

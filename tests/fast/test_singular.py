import numpy as np
import pytest

from ekfsim.diagnostics.nees import squared_mahalanobis
from ekfsim.fast.many import nees as many


@pytest.mark.parametrize("n", [2, 3])
def test_nearly_singular_covariances_have_the_rank_that_the_text_counts(n):
    """There neither has all digits of the value; of the rank there must be no doubt."""
    random = np.random.default_rng(5)
    V = np.linalg.qr(random.normal(size=(4000, n, n)))[0]
    λ = np.ones((4000, n))
    λ[:, -1] = 10 ** random.uniform(-17, -6, 4000)
    λ[::2, 0] = 10 ** random.uniform(-17, -6, 2000)
    σ = 10 ** random.uniform(-6, 2, (4000, n))
    P = (V * λ[:, None, :]) @ V.mT * σ[:, :, None] * σ[:, None, :]
    P = (P + P.mT) / 2
    e = np.matvec(P, random.normal(size=(4000, n)) / σ / σ)
    e[1::4] += 1e-6 * random.normal(size=(1000, n))
    _, rank, impossible = many.squared_mahalanobis(e, P)
    _, told_rank, told_impossible = squared_mahalanobis.text(e, P)
    np.testing.assert_array_equal(rank, told_rank)
    np.testing.assert_array_equal(impossible, told_impossible)
    assert set(rank.tolist()) >= {n - 1, n}


def test_straight_ways_are_left_to_the_text_nowhere():
    """The start certain, then straight ahead in many directions: what a study meets at every
    start.
    """
    θ = np.linspace(-np.pi, np.pi, 400)
    way = np.stack([np.cos(θ), np.sin(θ), np.zeros(400)], axis=-1)
    F = np.tile(np.eye(3), (400, 1, 1))
    F[:, 0, 2], F[:, 1, 2] = -2 * np.sin(θ), 2 * np.cos(θ)
    straight = 0.04 * way[:, :, None] * way[:, None, :]
    turned = F @ np.diag([0.0, 0.0, 0.02**2]) @ F.mT
    for P, rank in ((0 * straight, 0), (straight, 1), (turned, 1), (straight + turned, 2)):
        found = many.singular(np.zeros((400, 3)), P)
        assert found[1].tolist() == [rank] * 400

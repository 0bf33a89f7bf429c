"""The misprints of the documents that are no model's own; those of the models stand in models/test_model_errata.py."""

import math

import numpy as np

from ekfsim.filters.unscented import sigma_points, square_root, unscented_transform, weights
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.models.move_turn import MoveTurn


def test_erratum_classroom_sample_prints_the_command_and_moves_by_another():
    """Document 002, the narrative: from the first pose to the second leads another move than the one it prints."""
    before, after = (
        np.array([1.10114, -1.25, math.radians(86.0965)]),
        np.array([1.22095, 0.505793, math.radians(181.969)]),
    )
    printed = MoveTurn(0.0, 0.0).f(before, np.array([1.75, math.radians(90)]))
    assert np.hypot(*(printed - after)[:2]) > 0.009
    implied = np.array([np.hypot(*(after - before)[:2]), after[2] - before[2]])
    np.testing.assert_allclose(implied, [1.7599, math.radians(95.8725)], atol=1e-4)
    np.testing.assert_allclose(MoveTurn(0.0, 0.0).f(before, implied)[:2], after[:2], atol=1e-3)


def test_erratum_classroom_sample_grows_a_variance_by_a_reading():
    """Document 002, the narrative: σ_y² rises from 0.0038 to 0.0301 at a reading; eq. 12 lowers every variance."""
    before = np.array([
        [0.0300499, -0.000998142, -0.00991148],
        [-0.000998142, 0.00375455, 0.000676311],
        [-0.00991148, 0.000676311, 0.0362557],
    ])  # fmt: skip
    H = np.array([[0.0, 1.00059, 0.0689879]])
    K = before @ H.T / (H @ before @ H.T + 1e-4)
    after = (np.eye(3) - K @ H) @ before
    assert (np.diag(after) <= np.diag(before)).all()
    assert after[1, 1] < 0.0038 < 0.0301436


def test_erratum_classroom_two_sigma_are_no_954_percent_of_an_ellipse():
    """Document 002, section 4: 95.4 % in two dimensions is k = √(−2 ln(1 − 0.954)); 2 would hold 86.5 %."""
    assert abs(radius_factor(0.954) - 2.4816) < 5e-5
    assert abs(1 - math.exp(-(2**2) / 2) - 0.865) < 5e-4
    points = np.random.default_rng(1).normal(size=(100_000, 2))
    inside = [np.mean(np.hypot(*points.T) <= k) for k in (2.0, radius_factor(0.954))]
    np.testing.assert_allclose(inside, [0.8647, 0.954], atol=4e-3)


def test_erratum_pioneer_eq_14_needs_the_minus_in_its_third_line():
    """Document 001, eq. 14: with a plus there, too, the points lie on one side and their mean is not x̄."""
    mean, P = np.array([1.0, 2.0]), np.array([[0.04, 0.01], [0.01, 0.09]])
    w = weights(2)
    right = sigma_points(mean, square_root(P), w.spread)
    np.testing.assert_allclose(w.mean @ right, mean, atol=1e-15)
    np.testing.assert_allclose((w.mean * (right - mean).T) @ (right - mean), P, atol=1e-15)
    wrong = np.concatenate([right[:3], right[1:3]])
    assert np.abs(w.mean @ wrong - mean).max() > 0.1


def test_erratum_pioneer_eqs_20_and_21_have_weights_of_their_own():
    """Document 001, eqs 20, 21: the scaled transform counts the first point otherwise in mean and in covariance."""
    scaled, julier = weights(2, alpha=1e-3, beta=2.0, kappa=0.0), weights(2)
    np.testing.assert_allclose(julier.mean, julier.covariance, atol=1e-15)
    assert abs(scaled.covariance[0] - scaled.mean[0] - (1 - 1e-6 + 2)) < 1e-6

    def position(polar):
        r, bearing = polar[..., 0], polar[..., 1]
        return np.stack([r * np.cos(bearing), r * np.sin(bearing)], axis=-1)

    mean, P = np.array([1.0, math.pi / 2]), np.diag([0.02, math.radians(15)]) ** 2
    both = unscented_transform(mean, P, position, scaled)
    alike = unscented_transform(mean, P, position, scaled._replace(covariance=scaled.mean))
    assert both.covariance[1, 1] - alike.covariance[1, 1] > 2e-3


def test_erratum_mower_table_1_has_a_variance_that_is_not_its_deviation_squared():
    """Document 000, table 1: heading errors of 3.488° deviation and 2.168 variance; the other three pairs agree."""
    for deviation, variance in ((0.296, 0.088), (0.171, 0.029), (1.301, 1.695)):
        assert abs(deviation**2 - variance) < 3e-3
    assert 3.488**2 > 5 * 2.168


def test_erratum_mower_listing_asks_of_all_eigenvalues_what_one_would_show():
    """Document 000, listing: `if eig(P)<0` holds in MATLAB only if every eigenvalue is negative: it never warns."""
    λ = np.linalg.eigvalsh(np.array([[1.0, 2.0], [2.0, 1.0]]))
    assert (λ < 0).any()
    assert not (λ < 0).all()


def test_erratum_mower_eq_12_and_eq_28_are_one_for_the_optimal_gain():
    """Document 000, eqs 12 and 28: no misprint; for this K the short form and Joseph's are the same to rounding."""
    random = np.random.default_rng(3)
    A = random.normal(size=(3, 3))
    P, H, R = A @ A.T, random.normal(size=(2, 3)), np.diag([0.04, 0.09])
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
    I_KH = np.eye(3) - K @ H
    np.testing.assert_allclose(I_KH @ P @ I_KH.T + K @ R @ K.T, I_KH @ P, atol=1e-12)

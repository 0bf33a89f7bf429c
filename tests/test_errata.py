"""The misprints of the documents that are no model's own; those of the models stand in
models/test_model_errata.py."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from documents import as_written, equation

from ekfsim.cli.program.options import DOCUMENTS
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import sigma_points, unscented_transform, weights
from ekfsim.geometry.ellipse import ellipse, radius_factor
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.polar import cartesian, cartesian_moments
from ekfsim.models.sensors.position import Position
from ekfsim.simulation.bench import sigma_of
from ekfsim.systems.echo import Pair, flight_bound


def test_erratum_classroom_sample_prints_the_command_and_moves_by_another():
    """Document 002, the narrative: from the first pose to the second leads another move than the
    one it prints."""
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
    """Document 002, the narrative: σ_y² rises from 0.0038 to 0.0301 at a reading; eq. 12 lowers
    every variance."""
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


def sample_of_the_classroom():
    """Document 002, the narrative: its two covariances, and what is printed of each ellipse and
    cone."""
    _, _, sample = as_written("002").partition("==>The robot moved")
    rows = re.findall(r"\[+([-\d. ]+)\]", sample)
    covariances = [
        np.array([[float(n) for n in row.split()] for row in rows[i : i + 3]]) for i in (0, 3)
    ]

    def printed(words):
        return [float(number) for number in re.findall(rf"{words} is ([\d.]+)", sample)]

    ellipses = [
        printed(words)
        for words in ("minor radius", "major radius", "orientation", r"2\*sigma_theta")
    ]
    return list(zip(covariances, *ellipses, strict=True))


def test_erratum_classroom_sample_has_cones_that_are_not_of_its_covariances():
    told = [
        (math.degrees(2 * math.sqrt(P[2, 2])), printed)
        for P, _, _, _, printed in sample_of_the_classroom()
    ]
    np.testing.assert_allclose(told, [(21.82, 12.44284), (15.44, 10.01445)], atol=5e-3)


def test_erratum_classroom_sample_has_ellipses_that_lie_otherwise():
    told = []
    for P, _, _, printed, _ in sample_of_the_classroom():
        (_, major) = np.linalg.eigh(P[:2, :2])[1].T
        told.append((math.degrees(math.atan2(major[1], major[0])) % 180, printed))
        assert told[-1][0] == pytest.approx(math.degrees(ellipse(P, 0.954).orientation))
    np.testing.assert_allclose(told, [(177.83, 169.91084), (54.95, 75.51344)], atol=5e-3)


def test_erratum_classroom_sample_has_ellipses_of_other_radii():
    """Neither 2 standard deviations, as its section 4 has it, nor the 2.4816 of 95.4 % make what is
    printed."""
    found = sample_of_the_classroom()
    roots = np.sqrt([np.linalg.eigvalsh(P[:2, :2]) for P, *_ in found])  # minor, major
    np.testing.assert_allclose(2 * roots, [[0.122, 0.347], [0.209, 0.398]], atol=5e-4)
    np.testing.assert_allclose(
        radius_factor(0.954) * roots, [[0.151, 0.430], [0.259, 0.494]], atol=5e-4
    )
    printed = np.array([[minor, major] for _, minor, major, _, _ in found])
    np.testing.assert_allclose(printed, [[0.131259, 0.35163], [0.0481291, 0.343865]])
    factors = printed / roots
    # no one number of standard deviations makes both radii of an ellipse
    assert np.ptp(factors, axis=1).min() > 0.1


def test_erratum_classroom_two_sigma_are_no_954_percent_of_an_ellipse():
    """Document 002, section 4: 95.4 % in two dimensions is k = √(−2 ln(1 − 0.954)); 2 would hold
    86.5 %."""
    assert abs(radius_factor(0.954) - 2.4816) < 5e-5
    assert abs(1 - math.exp(-(2**2) / 2) - 0.865) < 5e-4
    points = np.random.default_rng(1).normal(size=(100_000, 2))
    inside = [np.mean(np.hypot(*points.T) <= k) for k in (2.0, radius_factor(0.954))]
    np.testing.assert_allclose(inside, [0.8647, 0.954], atol=4e-3)


def polar_reading():
    """Document 001, section II D: a sonar's range of 1 m ± 2 cm and a bearing of 90° ± 15°."""
    return np.array([1.0, math.pi / 2]), np.diag([0.02, math.radians(15)]) ** 2


def test_no_erratum_the_pioneer_s_eqs_14_20_21_and_33_are_right():
    """Document 001: the minus of the third line, a weight for the mean and one for the covariance,
    the arctangent."""
    lines = equation("001", 14).split(r"\\")
    assert [r"\bar{x}+\left(" in line for line in lines] == [False, True, False]
    assert r"\mathcal{X}_{i+n}&=\bar{x}-\left(" in lines[2]
    assert "W_i^{(m)}" in equation("001", 20)
    assert "W_i^{(c)}" in equation("001", 21)
    assert r"\tan^{-1}" in equation("001", 33)
    mean, P = polar_reading()
    w = weights(2)
    points = sigma_points(mean, square_root(P), w.spread)
    np.testing.assert_allclose(points[3:] - mean, mean - points[1:3], atol=1e-15)
    np.testing.assert_allclose(w.mean @ points, mean, atol=1e-15)
    np.testing.assert_allclose((w.covariance * (points - mean).T) @ (points - mean), P, atol=1e-15)


def test_erratum_pioneer_eqs_20_and_21_have_weights_that_are_told_nowhere():
    """Document 001: W⁽ᵐ⁾ and W⁽ᶜ⁾ stand in eqs 20 to 25 alone; eq. 14 has one W, which is both for
    Julier's points."""
    text = as_written("001")
    before, after = text.split(r"\quad (14)$$")[0], text.split(r"\quad (25)$$")[1]
    assert "^{(m)}" not in before + after
    assert "^{(c)}" not in before + after
    scaled, julier = weights(2, alpha=1e-3, beta=2.0, kappa=0.0), weights(2)
    np.testing.assert_allclose(julier.mean, julier.covariance, atol=1e-15)
    assert abs(scaled.covariance[0] - scaled.mean[0] - (1 - 1e-6 + 2)) < 1e-6
    both = unscented_transform(*polar_reading(), cartesian, scaled)
    alike = unscented_transform(
        *polar_reading(), cartesian, scaled._replace(covariance=scaled.mean)
    )
    assert both.covariance[1, 1] - alike.covariance[1, 1] > 2e-3


def test_erratum_pioneer_eqs_1_and_2_are_called_linear():
    """Document 001: a general F of state, input and noise is linear where it is eq. 3, and else
    not."""
    text = as_written("001")
    assert "governed by the linear equation given by (1) and (2)" in text
    assert "Figure 1 Discrete-time nonlinear dynamic system" in text
    assert equation("001", 1) == "x_{k+1}=F(x_k,u_k,w_k)"
    a, b = np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.5, 1.0])
    motion, u = MoveTurn(0.0, 0.0), np.array([1.0, 0.3])
    middle = motion.f((a + b) / 2, u) - (motion.f(a, u) + motion.f(b, u)) / 2
    assert np.abs(middle).max() > 0.1  # the document's own robot drives by sines, too: eqs 31, 32


def test_erratum_pioneer_exchanges_R_and_Q_in_two_paragraphs():
    """Document 001, after eqs 4 and 8: eq. 3 adds w to the state and eq. 8 adds Q; eq. 4 adds v,
    eq. 9 R."""
    text = as_written("001")
    assert "w and v represent the process and measurement noise" in text
    assert "they have the covariance R and Q" in text
    assert "Q represents the covariance of the process noise v" in text
    assert "R is denoted the covariance of the measurement noise w" in text
    assert equation("001", 3).endswith("w_{k-1}")
    assert equation("001", 4).endswith("v_k")
    assert equation("001", 8).endswith("+Q")
    assert "+R)^{-1}" in equation("001", 9)


def test_erratum_pioneer_sigma_points_do_not_capture_every_covariance():
    """Document 001, section II C, against its own section II D."""
    assert "capture the true mean and covariance of any nonlinear system" in as_written("001")
    told = unscented_transform(*polar_reading(), cartesian, weights(2))
    mean, covariance = cartesian_moments(polar_reading()[0], 0.02, math.radians(15))
    assert abs(told.mean - mean).max() < 1e-5
    assert round(told.covariance[1, 1], 6) == 0.002670
    assert round(covariance[1, 1], 6) == 0.002568


def test_erratum_pioneer_figure_2_has_neither_its_mean_nor_its_circle():
    """Document 001, section II D, against 200 000 readings."""
    text = as_written("001")
    assert "not coinciding with the real one at (0,1)" in text
    assert "the covariance of the points is a circular one" in text
    random, (mean, P) = np.random.default_rng(1), polar_reading()
    many = cartesian(mean + random.normal(size=(200_000, 2)) * np.sqrt(np.diagonal(P)))
    np.testing.assert_allclose(many.mean(axis=0), [0, 0.966], atol=2e-3)
    across, along = np.var(many, axis=0)
    assert 24 < across / along < 26


def test_erratum_pioneer_figure_5_means_a_low_ratio():
    """Document 001, section IV B: much noise is hard: by the bound, ten times the noise, four times
    the σ of τ."""
    assert "even in the case of the high signal to noise ratio" in as_written("001")
    pair = Pair()
    loud, quiet = (flight_bound(pair.typical, sigma_of(snr), pair) for snr in (30.0, 10.0))
    assert quiet > 4 * loud


def test_erratum_mower_has_its_markers_in_a_tenth_of_their_area():
    """Document 000, section 1 says so of 10 m²; section 2 has one marker in each square of roughly
    six metres."""
    text = as_written("000")
    assert "three to four markers per 10 m^2" in text
    assert "28 markers placed at roughly six meter intervals" in text
    assert 10 / 6**2 < 0.3
    assert 2.5 < 100 / 6**2 < 4


def test_erratum_gnss_figure_2_names_fixes_that_have_no_heading():
    """Document 003: the caption of figure 2, which draws φ, names the detections of figure 1."""
    assert re.search(
        r"Figure 2: [^:]*the GNSS detections, and the estimated \S*(phi|ϕ|φ)", as_written("003")
    )
    heading = np.eye(4)[1]  # of the state (V, φ, x, y)
    _, H, _ = Position(0.1, 0.1, SPEED_POSE).linearize(np.zeros(4))
    assert not np.any(H @ heading)


def test_erratum_pylon_eq_1_predicts_at_a_state_that_nothing_defines():
    """Document 004, eq. 1: h(x̄), where the algorithm has a predicted mean μ̄."""
    text = as_written("004")
    assert text.count(r"h(\bar{x}_t)") == 1
    assert text.count(r"\bar{x}") == 1
    assert r"\bar{\mu}_t &= g(\mu_{t-1}, u_t)" in text


def test_erratum_pylon_tells_variances_in_metres():
    """Document 004, figure 5: "variances … on the order of 10^{-5}m"."""
    text = as_written("004")
    assert text.count("on the order of $10^{-5}m$") == 2
    assert "Because the position variances are very small" in text


def test_erratum_mower_table_1_has_a_variance_that_is_not_its_deviation_squared():
    """Document 000, table 1: heading errors of 3.488° deviation and 2.168 variance; the other three
    pairs agree."""
    for deviation, variance in ((0.296, 0.088), (0.171, 0.029), (1.301, 1.695)):
        assert abs(deviation**2 - variance) < 3e-3
    assert 3.488**2 > 5 * 2.168


def test_erratum_mower_listing_asks_of_all_eigenvalues_what_one_would_show():
    """Document 000, listing: `if eig(P)<0` holds in MATLAB only if every eigenvalue is negative: it
    never warns."""
    λ = np.linalg.eigvalsh(np.array([[1.0, 2.0], [2.0, 1.0]]))
    assert (λ < 0).any()
    assert not (λ < 0).all()


def test_erratum_mower_eq_12_and_eq_28_are_one_for_the_optimal_gain():
    """Document 000, eqs 12 and 28: no misprint; for this K the short form and Joseph's are the same
    to rounding."""
    random = np.random.default_rng(3)
    A = random.normal(size=(3, 3))
    P, H, R = A @ A.T, random.normal(size=(2, 3)), np.diag([0.04, 0.09])
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
    I_KH = np.eye(3) - K @ H
    np.testing.assert_allclose(I_KH @ P @ I_KH.T + K @ R @ K.T, I_KH @ P, atol=1e-12)


@pytest.mark.parametrize("number", ["000", "001", "002", "003", "004"])
def test_who_looks_a_document_up_finds_its_title_and_its_authors(number):
    told = (Path(__file__).parents[1] / "docs" / "reference" / "systems.md").read_text(
        encoding="utf-8"
    )
    row = next(line for line in told.splitlines() if line.startswith(f"| {number} |"))
    title, helped = row.split("*")[1], " ".join(DOCUMENTS.split())
    assert title in helped
    assert f"{number} {row.split('|')[2].strip()} " in helped
    beginning = as_written(number)[:400]
    assert title in beginning
    authors = row.split("|")[3].partition(", *")[0].replace(" and ", ", ").split(", ") * (
        number != "002"
    )
    assert all(author.split()[-1] in beginning for author in authors)

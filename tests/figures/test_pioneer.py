"""The figures of document 001, by their artists and numbers."""

import csv
import math
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numerics import jacobian

import ekfsim
from ekfsim.figures.album import Album, filled
from ekfsim.figures.crowd import crowd_of, over_runs, set_down
from ekfsim.figures.pioneer import beams, echo, flight, polar, square
from ekfsim.figures.pioneer import document as pioneer
from ekfsim.figures.pioneer import filters as pioneer_filters
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.filters.ukf import UKF
from ekfsim.models.sensors.infrared import COLOURS
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.polar import cartesian, cartesian_jacobian, cartesian_moments
from ekfsim.raycast.walls import Walls
from ekfsim.records import Log
from ekfsim.simulation.bench import gaussian, readings
from ekfsim.systems.instruments import Infrared, Ultrasonic

REFERENCE = {  # by scripts that share no code with this project
    "exact": (0, 0.966311, 0.064074, 0.002568),
    "linearised (EKF)": (0, 1.0, 0.068539, 0.000400),
    "unscented, κ = 1": (0, 0.966314, 0.063968, 0.002670),
    "unscented, κ = 0": (0, 0.966120, 0.065464, 0.001548),
    "scaled, α = 0.001, β = 2, κ = 0": (0, 0.965731, 0.068539, 0.002749),
}


@dataclass
class Kept(Album):
    """An album that keeps its figures."""

    figures: dict = field(default_factory=dict)

    def add(self, figure, name, title, caption):
        self.figures[name] = figure
        super().add(figure, name, title, caption)


@pytest.fixture
def album(tmp_path):
    return Kept("title", "source", tmp_path)


@pytest.fixture(scope="module")
def scene():
    return ekfsim.load_scene("pioneer")


def lines(axes):
    """The lines of axes by what the legend calls them."""
    return {
        line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")
    }


def rows(album, name):
    with (album.folder / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


# the polar reading


def test_the_moments_of_the_polar_reading_are_the_reference_s(scene, album):
    polar.draw_polar(scene, album)
    table = {
        row["method"]: [float(value) for value in list(row.values())[1:-1]]
        for row in rows(album, "moments")
    }
    for method, expected in REFERENCE.items():
        assert table[method] == pytest.approx(expected, abs=1e-6)
    assert table["Monte Carlo, 1,000,000 readings"] == pytest.approx(REFERENCE["exact"], abs=1e-3)


def test_figure_2_shows_both_means_and_the_sigma_points(scene, album):
    polar.draw_polar(scene, album)
    left, right = album.figures["fig2-unscented"].axes
    for axes, label, means in (
        (left, "linearised (eq. 19)", [0.966311, 1.0]),
        (right, "unscented, κ = 1", [0.966311, 0.966314]),
    ):
        found = [line.get_xydata()[0] for line in axes.get_lines() if len(line.get_xydata()) == 1]
        assert np.array(found) == pytest.approx(np.array([[0, y] for y in means]), abs=1e-6)
        assert label in lines(axes)
    points = lines(right)["sigma points (eqs 14, 15)"].get_xydata()
    assert len(points) == 5
    assert np.hypot(*points.T) == pytest.approx(
        [1, 1 + 0.02 * math.sqrt(3), 1, 1 - 0.02 * math.sqrt(3), 1]
    )


def test_cartesian_has_the_jacobian_of_eq_19():
    for seed in range(5):
        x = np.random.default_rng(seed).uniform(0.5, 3, 2)
        np.testing.assert_allclose(cartesian_jacobian(x), jacobian(cartesian, x), atol=1e-8)


def test_exact_moments_are_those_of_many_readings():
    at = np.array([2.0, 0.7])
    mean, covariance = cartesian_moments(at, 0.1, 0.4)
    P = np.diag([0.1, 0.4]) ** 2
    many = cartesian(gaussian(np.broadcast_to(at, (400_000, 2)), P, np.random.default_rng(0)))
    np.testing.assert_allclose(many.mean(axis=0), mean, atol=4e-3)
    np.testing.assert_allclose(np.cov(many.T), covariance, atol=4e-3)


# infrared and ultrasonic


def test_figure_4_has_a_straight_line_over_the_logarithm_for_every_colour(scene, album):
    beams.draw_infrared(scene, album)
    left, right = album.figures["fig4-infrared"].axes
    assert right.get_xscale() == "log"
    for colour in beams.SHADES:
        r, volts = lines(right)[f"{colour}, ρ = {COLOURS[colour]:g}"].get_data()
        slope, offset = np.polyfit(np.log(r), volts, 1)
        assert (-slope, offset) == pytest.approx((COLOURS[colour], COLOURS[colour]))
    assert left.get_legend() is not None


def test_infrared_readings_scatter_by_sigma():
    beam = beams.infrared_beam(Infrared(), "red")
    x = beams.facing(np.full(20_000, 0.7))
    error = readings(beam, x, np.random.default_rng(0)) - beam.h(x)
    assert error.std() == pytest.approx(0.05, rel=0.02)


def test_figure_6_shows_the_sigma_that_the_filter_is_told(scene, album):
    beams.draw_ultrasonic(scene, album)
    left, right = album.figures["fig6-ultrasonic"].axes
    r, σ = lines(left)["σ(r) of the model"].get_data()
    ring = Ultrasonic()
    assert (r[0], r[-1]) == pytest.approx((0.1, 2.0))
    assert σ == pytest.approx(1e3 * (ring.sigma + ring.sigma_per_metre * r))
    _, measured = lines(left)[f"root mean square of {beams.EACH}"].get_data()
    assert measured == pytest.approx(σ, rel=0.2)
    assert lines(right)["σ²(r) of the model"].get_data()[1] == pytest.approx(σ**2)


# the echo


def test_figure_5_marks_the_flight(scene, album):
    echo.draw_echo(scene, album)
    whole, close = album.figures["fig5-echo"].axes
    true = 2 / 343 * 1e3
    assert lines(close)["true τ"].get_xdata()[0] == pytest.approx(true)
    assert lines(close)["20 % of the peak"].get_xdata()[0] > true
    t, signal = lines(whole)["signal"].get_data()
    assert np.diff(t) == pytest.approx(5e-3)
    assert np.all(lines(whole)["Hilbert envelope"].get_ydata() >= np.abs(signal) - 1e-9)
    band = next(patch for patch in close.patches if patch.get_label() == "τ ± 2σ by the UKF")
    assert band.get_x() < true < band.get_x() + band.get_width()
    # αT after the arrival, this echo's α is 1.8
    assert "e^3.6 = 37 times as high" in " ".join(album.pages[0].split())


def test_the_printed_envelope_is_drawn_where_the_print_is_followed(scene, album):
    echo.draw_echo(replace(scene, reading="printed"), album)
    t, grown = lines(album.figures["fig5-echo"].axes[0])["eq. 38 as printed"].get_data()
    seen = grown[(t > 5.9) & np.isfinite(grown)]
    assert np.all(np.diff(seen) > 0)  # it never falls
    assert "green, cut off" in " ".join(album.pages[0].split())


def test_the_ukf_is_better_than_the_threshold_at_20_dB_and_best_at_30():
    at_20, at_30 = (flight.trial(flight.Pair(), snr, 80, 1) for snr in (20.0, 30.0))
    for at, factor in ((at_20, 1.2), (at_30, 2.0)):
        assert flight.rmse(at.threshold) > factor * flight.rmse(at.ukf)
        assert flight.rmse(at.ukf) > at.bound
    assert flight.rmse(at_20.ukf) == pytest.approx(14e-6, abs=2e-6)


def test_the_flight_is_drawn_and_told_over_the_SNR(scene, album, monkeypatch):
    monkeypatch.setattr(flight, "TRIALS", 5)
    flight.draw_flight(scene, album)
    axes = album.figures["fig5b-flight"].axes[0]
    table = rows(album, "flight")
    assert [row["SNR (dB)"] for row in table] == ["0", "5", "10", "15", "20", "25", "30"]
    drawn = lines(axes)["UKF, four parameters"].get_ydata()
    assert [float(row["UKF RMSE (µs)"]) for row in table] == pytest.approx(drawn, abs=0.06)
    assert flight._millimetres(1e6) == pytest.approx(343e3 / 2)
    assert flight._microseconds(flight._millimetres(7.0)) == pytest.approx(7)


# the square, and the three filters


def test_figure_7_shows_that_odometry_drifts_and_the_filter_does_not(scene, album):
    square.draw_square(scene, album, "")
    floor, position, heading = album.figures["fig7-square"].axes
    drawn = lines(floor)
    truth, reckoned, believed = (
        drawn[name].get_xydata() for name in ("truth", "odometry alone", "EKF")
    )
    corners = np.array([[1, 1], [3, 1], [3, 3], [1, 3.0]])
    assert np.hypot(*(truth[:, None] - corners).T).min(axis=1) == pytest.approx(0, abs=0.05)
    assert np.hypot(*(reckoned - truth).T).max() > 0.1
    assert np.hypot(*(believed - truth).T).max() < 0.05
    assert floor.get_aspect() == 1
    assert len(position.patches) == len(heading.patches) == 4  # the corners


@pytest.fixture(scope="module")
def crowds(scene):
    start = set_down(scene, 0.02, 2.0)
    found = {name: crowd_of(replace(start, filter=name), 20) for name in pioneer_filters.NAMES}
    return found | {pioneer_filters.CAUTIOUS: crowd_of(start, 20, pioneer_filters.CautiousEKF())}


def test_the_lkf_is_lost_after_the_first_corner_unless_it_knows_the_plan(scene, crowds):
    t, turning = square.corners(scene)
    first = crowds["ekf"].t < t[np.argmax(turning)]
    assert t[np.argmax(turning)] == pytest.approx(8.0)
    assert np.sqrt(np.mean(crowds["kf"].position[first] ** 2)) < 0.02
    assert over_runs(crowds["kf"].position)[~first].max() > 1
    assert crowds["kf"].lost == 1
    for name in crowds.keys() - {"kf"}:
        assert over_runs(crowds[name].position).max() < 0.04
        assert crowds[name].lost == 0
        assert 1 < np.mean(crowds[name].nees) < 6
        # driven and read alike
        np.testing.assert_array_equal(crowds["kf"].reckoned, crowds[name].reckoned)
    ekf, about_the_plan = (crowds[name].position for name in ("ekf", "kf-nominal"))
    assert np.sqrt(np.mean(about_the_plan**2)) == pytest.approx(np.sqrt(np.mean(ekf**2)), rel=0.05)


def test_the_cautious_ekf_refuses_what_the_ukf_would(scene):
    """A point of its belief looks past the post; the mean does not."""
    post = Walls.of({"post": np.array([[5, -0.2], [5.4, -0.2], [5.4, 0.2], [5, 0.2]])})
    prior, laser = Gaussian(np.zeros(3), np.diag([0.01, 0.01, 0.04])), Laser(post, 0.0, 0.01)
    for filter, refused in (
        (EKF(), 0),
        (pioneer_filters.CautiousEKF(), Refused.GUARD),
        (UKF(), Refused.NO_WALL),
    ):
        assert filter.update(prior, laser, np.array([5.0]))[1].refused == refused
    sure = Gaussian(np.zeros(3), np.diag([1e-4, 1e-4, 1e-6]))
    told, plain = (
        f.update(sure, laser, np.array([5.1]))[0] for f in (pioneer_filters.CautiousEKF(), EKF())
    )
    np.testing.assert_array_equal(told.mean, plain.mean)


def test_a_crowd_is_its_runs(scene, crowds):
    """The last error of run 7, played alone."""
    last = list(ekfsim.play(replace(set_down(scene, 0.02, 2.0), run=7)))[-1]
    np.testing.assert_allclose(
        (last.posterior.mean - last.entry.truth)[:2], crowds["ekf"].error[-1, 7, :2], atol=1e-12
    )
    assert crowds["ekf"].nees[7] == pytest.approx(float(last.nees.value))


def test_the_filters_are_drawn_and_told(scene, album, crowds):
    pioneer_filters._draw_over_time(scene, album, crowds)
    position, heading = album.figures["fig8-filters"].axes
    assert list(lines(position)) == ["odometry alone", *pioneer_filters.NAMES.values()]
    for name, label in pioneer_filters.NAMES.items():
        assert lines(position)[label].get_ydata() == pytest.approx(
            1e3 * over_runs(crowds[name].position)
        )
    assert [text.get_text() for text in position.get_legend().get_texts()] == list(lines(position))
    assert heading.get_xlabel() == "time (s)"


def test_the_table_tells_every_start_and_filter_with_its_spread(scene, album, crowds):
    pioneer_filters._tabulate(scene, album, [crowds] * 3)
    table = rows(album, "filters")
    names = ["odometry alone", *pioneer_filters.NAMES.values(), "cautious EKF"]
    assert [row["filter"] for row in table] == names * 3
    assert [row["set down to"] for row in table[:: len(names)]] == [
        "2 cm, 2°",
        "20 cm, 20°",
        "30 cm, 30°",
    ]
    assert [row["lost (%)"] for row in table[: len(names)]] == ["–", "100.0", *["0.0"] * 5]
    assert table[1]["95 % of them"] == "[83.9, 100.0]"  # Wilson's, of 20 of 20
    for row in table[: len(names)]:
        low, high = map(float, row["95 % of it"][1:-1].split(", "))
        assert low < float(row["position RMSE (mm)"]) < high
    told = " ".join(album.pages[0].split())
    assert "what is unscented +0.0 [" in told
    assert told.count("The EKF errs by") == 6


def test_an_interval_of_a_ratio_holds_the_right_one(crowds):
    """Of runs that err twice as much it is 2; of the same runs in another order it holds 1."""
    crowd = crowds["ekf"]
    twice, shuffled = (
        replace(crowd, error=2 * crowd.error),
        replace(crowd, error=crowd.error[:, ::-1]),
    )
    low, ratio, high = pioneer_filters._ratio("ukf", "ekf", {"ekf": crowd, "ukf": twice})
    assert (low, ratio, high) == pytest.approx((2, 2, 2))
    low, ratio, high = pioneer_filters._ratio("ukf", "ekf", {"ekf": crowd, "ukf": shuffled})
    assert ratio == pytest.approx(1)
    assert 0.8 < low < 1 < high < 1.25
    assert "the EKF is better, 2.00 times" in pioneer_filters._compared(
        "ekf", "ukf", {"ekf": crowd, "ukf": twice}
    )
    assert "no difference that 20 runs can tell" in pioneer_filters._compared(
        "ekf", "ukf", {"ekf": crowd, "ukf": shuffled}
    )


def test_what_eq_33_s_arctangent_makes_of_the_corners_is_told(scene):
    told, x = " ".join(square.told_of_arctan(scene).split()), math.tan(math.radians(4.5))
    assert (
        f"the two differ by {80 * math.degrees(x - math.atan(x)):.2f}° over the four corners"
        in told
    )
    assert "`--reading printed` and `coded` change nothing here" in told


def recorded(scene, truth=True):
    """The same run as a log."""
    entries = tuple(
        entry if truth else replace(entry, truth=None) for entry in ekfsim.simulate(scene)
    )
    return replace(scene, log=Log(entries, ekfsim.first_belief(scene)), drive=None)


def test_a_recorded_run_is_filtered_as_the_simulated_one(scene, album):
    square.draw_square(scene, album, "")
    drawn = lines(album.figures["fig7-square"].axes[0])["EKF"].get_xydata()
    square.draw_square(recorded(scene), album, "")
    np.testing.assert_array_equal(
        lines(album.figures["fig7-square"].axes[0])["EKF"].get_xydata(), drawn
    )
    assert "The square of 2 × 2 m in a room of 4 × 4 m, driven once in 40 s" in " ".join(
        album.pages[0].split()
    )
    assert "A recorded run of 40 s in a room of 4 × 4 m." in album.pages[1]
    pioneer._tabulate_log(recorded(scene), album)
    error = {row["filter"]: float(row["position RMSE (mm)"]) for row in rows(album, "filters")}
    assert error["EKF"] < 10 < 200 < error["odometry alone"] < 1000 < error["LKF"]


def test_a_log_without_truth_has_no_errors_and_says_so(scene, album):
    square.draw_square(recorded(scene, truth=False), album, "")
    (floor,) = album.figures["fig7-square"].axes
    assert "truth" not in lines(floor)
    pioneer._tabulate_log(recorded(scene, truth=False), album)
    told = " ".join(" ".join(album.pages).split())
    assert "The log tells no truth, so there are no errors to draw" in told
    assert "without it no filter can be called the better one" in told
    assert "nan" not in told


def test_what_no_log_tells_is_simulated_and_says_so(scene, album, monkeypatch):
    for name in ("draw_infrared", "draw_echo", "draw_flight", "draw_ultrasonic"):
        monkeypatch.setattr(pioneer, name, lambda scene, album: None)
    pioneer.draw_pioneer(recorded(scene), album)
    assert len(album.pages) == 4  # the polar reading and its table, the square and the filters
    sources = {name: figure.texts[-1].get_text() for name, figure in album.figures.items()}
    assert sources["fig2-unscented"].startswith("Simulated, whatever was recorded: ekfsim ")
    assert sources["fig7-square"] == "source"


# the page of captions


def test_captions_have_even_lines_and_lists_stay():
    assert filled("\na\nb\n\n- c\n- d\n") == "a b\n\n- c\n- d"
    assert max(map(len, filled("word " * 60).splitlines())) <= 120

"""The misprints of the documents, each shown by what it contradicts."""

import math

import numpy as np
import pytest
from documents import equation
from numerics import jacobian

from ekfsim.models.layout import INERTIAL
from ekfsim.models.motions.planar_imu import PlanarImu
from ekfsim.models.motions.wheel_speeds import WheelSpeeds, WheelSpeedsAsWritten
from ekfsim.models.sensors.echo import envelope, printed_envelope
from ekfsim.models.sensors.landmarks import MarkerAngles
from ekfsim.models.sensors.offset import LandmarkOffset, to_global, to_global_as_printed
from ekfsim.systems.document import READINGS
from ekfsim.systems.robots import Pioneer

SEEDS = pytest.mark.parametrize("seed", range(5))


def close(a, b):
    np.testing.assert_allclose(a, b, atol=1e-6, rtol=1e-6)


@SEEDS
def test_erratum_mower_eq_25_has_the_wrong_sign(seed):
    """Document 000, eq. 25: ∂h_η/∂x and ∂h_η/∂y are printed without the minus that eq. 24 gives
    them."""
    x = np.random.default_rng(seed).uniform(-3, 3, 3)
    marker = (5.0, 4.0, 0.226, 0.048, 0.006)
    right, printed = MarkerAngles(*marker), MarkerAngles(*marker, elevation_sign=-1.0)
    derivative = jacobian(right.h, x)
    close(right.linearize(x)[1], derivative)
    close(printed.linearize(x)[1], derivative * [[1, 1, 1], [-1, -1, 1]])
    close(printed.linearize(x[None])[1][0], printed.linearize(x)[1])
    dx, dy = 5 - x[0], 4 - x[1]
    d = math.hypot(dx, dy)
    below = d * (0.226**2 + d**2)
    # eq. 25, to the letter
    close(printed.linearize(x)[1][1], [0.226 * dx / below, 0.226 * dy / below, 0])
    assert np.abs(derivative[1, :2]).max() > 1e-4


def test_erratum_mower_eq_23_cannot_tell_ahead_from_behind():
    """Document 000, eq. 23: the arctangent of a quotient; a marker behind needs that of two
    arguments, wrapped."""
    marker = MarkerAngles(-4.0, 1.0, 0.226, 0.048, 0.006)
    α = marker.h(np.zeros(3))[0]
    assert [4 * math.cos(α), 4 * math.sin(α)] == pytest.approx([-16 / 17**0.5, 4 / 17**0.5])
    printed = math.atan((1 - 0) / (-4 - 0)) - 0
    assert α - printed == pytest.approx(math.pi)
    across = marker.residual(np.array([math.pi - 0.1, 0.0]), np.array([-math.pi + 0.1, 0.0]))
    assert across[0] == pytest.approx(-0.2)


@SEEDS
def test_erratum_pylon_eq_5_has_a_minus_where_eq_7_has_a_plus(seed):
    """Document 004, eq. 5: ẏ gains (a_x sin yaw + a_y cos yaw) dt; with the printed minus eq. 7 is
    not its Jacobian."""
    random = np.random.default_rng(seed)
    x, u = random.uniform(-1, 1, 7), np.append(random.uniform(-1, 1, 3), 0.1)
    right, printed = PlanarImu(wrapped=False), PlanarImu(wrapped=False, lateral_sign=-1.0)
    eq_7 = right.G(x, u)
    close(printed.G(x, u), eq_7)
    close(jacobian(lambda u: right.f(x, u), u), eq_7)
    derivative = jacobian(lambda u: printed.f(x, u), u)
    ay, yaw, dt = u[1], u[2], u[3]
    close(
        derivative[2] - eq_7[2],
        [0, -2 * math.cos(yaw) * dt, 2 * ay * math.sin(yaw) * dt, -2 * ay * math.cos(yaw)],
    )
    close(np.delete(derivative, 2, axis=0), np.delete(eq_7, 2, axis=0))


def test_erratum_pylon_eq_5_has_eight_entries_for_a_state_of_seven():
    """Document 004, eq. 5: the left side lists θ̇_p between θ and θ_p; the text and eq. 6 have
    seven entries."""
    model, x, u = PlanarImu(), np.zeros(7), np.full(4, 0.1)
    assert len(INERTIAL.names) == 7
    assert model.f(x, u).shape == (7,)
    assert model.F(x, u).shape == (7, 7)


@SEEDS
def test_erratum_pylon_eq_7_leaves_out_the_row_of_the_yaw(seed):
    """Document 004, eq. 7: all derivatives of θ = yaw are printed as 0; the one by the yaw is 1."""
    random = np.random.default_rng(seed)
    x, u = random.uniform(-1, 1, 7), np.append(random.uniform(-1, 1, 3), 0.1)
    close(PlanarImu().G(x, u)[5], [0, 0, 1, 0])
    close(jacobian(lambda u: PlanarImu().f(x, u), u)[5], [0, 0, 1, 0])


@SEEDS
def test_erratum_pylon_eq_8_turns_by_the_yaw_itself(seed):
    """Document 004, eq. 8: for a lidar whose y-axis points ahead the angle is π/2 − θ; by θ, eq. 9
    is missed."""
    random = np.random.default_rng(seed)
    x = np.zeros(7)
    x[[1, 3, 5]] = random.uniform(-2, 2, 3)
    offset = LandmarkOffset(5.0, -5.0, 0.0075, 0.0075, INERTIAL).h(x)
    ahead, right = (
        np.array([math.cos(x[5]), math.sin(x[5])]),
        np.array([math.sin(x[5]), -math.cos(x[5])]),
    )
    lidar = np.array([right @ offset, ahead @ offset])
    close(to_global(lidar, x[5]), offset)
    close(to_global_as_printed(lidar, math.pi / 2 - x[5]), offset)
    assert math.dist(to_global_as_printed(lidar, x[5]), offset) > 0.1


def test_erratum_pylon_eq_7_has_eight_rows():
    """Document 004, eq. 7: a row for each of the eight entries of eq. 5's left side; the state has
    seven."""
    matrix = equation("004", 7).partition(r"\begin{bmatrix}")[2].partition(r"\end{bmatrix}")[0]
    assert len(matrix.split(r"\\")) == 8
    assert PlanarImu().G(np.zeros(7), np.full(4, 0.1)).shape == (7, 4)


def test_erratum_pylon_eq_10_leaves_out_the_yaw():
    """Document 004, eq. 10: Q_t holds the lidar's noise alone; the yaw's, times the lever arm, is
    the larger part."""
    x = np.zeros(7)
    printed = LandmarkOffset(5.0, -5.0, 0.0075, 0.0075, INERTIAL).linearize(x)[2]
    right = LandmarkOffset(5.0, -5.0, 0.0075, 0.0075, INERTIAL, 0.00058709**0.5).linearize(x)[2]
    close(printed, 0.0075**2 * np.eye(2))
    close(right - printed, 0.00058709 * np.full((2, 2), 25.0))
    assert right[0, 0] > 200 * printed[0, 0]


@SEEDS
def test_erratum_gnss_recipe_has_an_F_that_is_not_its_f_derived(seed):
    """Document 003, eqs 3, 4 as its authors wrote them: f takes V from the wheels, F as if it came
    from the state."""
    random = np.random.default_rng(seed)
    x, u, recipe = random.uniform(-1, 1, 4), np.array([0.9, 1.1, 0.005]), WheelSpeedsAsWritten()
    derivative, φ = jacobian(lambda x: recipe.f(x, u), x), x[1]
    close(recipe.F(x, u) - derivative, np.outer([0.5, 0, math.cos(φ), math.sin(φ)], [1, 0, 0, 0]))


def test_erratum_gnss_recipe_turns_straight_on_and_moves_by_the_step():
    """Document 003, eq. 3 as its authors wrote it, against the integrals of section 2 that it
    stands for."""
    straight = np.array([1.0, 1.0, 0.005])
    right, recipe = (
        WheelSpeeds(0.27, 0.1, 0.3).f(np.zeros(4), straight),
        WheelSpeedsAsWritten().f(np.zeros(4), straight),
    )
    assert right == pytest.approx([1, 0, 0.005, 0])  # 5 mm ahead
    assert recipe == pytest.approx([1, 0.27 * 0.005, 1, 0])  # turned, and 1 m ahead


@SEEDS
def test_no_erratum_the_pioneer_turns_by_the_arctangent_of_eq_33_in_every_reading(seed):
    """Document 001, eq. 33: tan⁻¹((Δd_R − Δd_L)/W), as printed."""
    assert equation("001", 33).endswith(
        r"\tan^{-1}\left(\frac{\Deltad_{R,k}-\Deltad_{L,k}}{W}\right)"
    )
    random = np.random.default_rng(seed)
    x, u = random.uniform(-1, 1, 3), random.uniform(0.1, 0.4, 2)
    for reading in READINGS:
        after = Pioneer(width=0.38).motion(reading).f(x, u)
        assert after[2] - x[2] == pytest.approx(math.atan((u[1] - u[0]) / 0.38))


def test_erratum_pioneer_eq_38_grows():
    """Document 001, eq. 38: printed with e^{+(t−τ)/T}, which never falls; an echo fades."""
    assert equation("001", 38).endswith(r"e^{\left(\frac{kt_s-\tau}{T}\right)}")
    t = np.linspace(0, 20, 401)
    right, printed = envelope(t, 1.0, 2.0, 0.5, 2.0), printed_envelope(t, 1.0, 2.0, 0.5, 2.0)
    after = t > 2
    assert (np.diff(printed[after]) > 0).all()
    assert right[-1] < 1e-10 < 1e10 < printed[-1]
    close(right[after] * np.exp(2 * (t[after] - 2) / 0.5) / printed[after], 1)
    assert t[right.argmax()] == pytest.approx(2 + 2 * 0.5)

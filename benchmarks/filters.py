"""The mower's whole run, 54 900 predictions at 100 Hz and two markers every two seconds, against
filterpy in a loop.

Ours takes each stretch between two readings at once. filterpy is handed f and F as plain floats, Q
= G M Gᵀ + Q and H by the same formulas, and predicts and updates one by one. Both see the same
inputs and readings.

python benchmarks/filters.py [--quick]
"""

import argparse
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from timing import optional, ratios

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.stretch import stretch
from ekfsim.geometry import Array
from ekfsim.models.motions.wheels import GyroWheels
from ekfsim.models.sensors.landmarks import MarkerAngles

STEPS, EVERY, MARKERS = 54_900, 200, 2
WIDTH, WHEEL, HEIGHT, AZIMUTH, ELEVATION = 0.5, 0.0016, 0.226, 0.048, 0.006
Q = np.diag([1e-6, 1e-6, 1e-7])
MOTION = GyroWheels(WIDTH, WHEEL, Q)
FIRST = Gaussian(np.zeros(3), Q)

Log = tuple[Array, list[list[tuple[MarkerAngles, Array]]]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer rounds, a tenth of the run")
    quick = parser.parse_args().quick
    steps = STEPS // 10 if quick else STEPS
    if optional("filterpy") is None:
        return
    log = recorded(steps)
    theirs = peer(log)
    ours, other = at_readings(log), theirs()
    difference = ours - other
    difference[:, 2] = np.arctan2(np.sin(difference[:, 2]), np.cos(difference[:, 2]))
    print(
        f"{steps} predictions, {MARKERS} markers every {EVERY}; largest difference "
        f"{np.abs(difference).max():.1e}"
    )
    for ratio in ratios(
        lambda: at_readings(log),
        {"filterpy, predict and update in a loop": theirs},
        3 if quick else 7,
    ):
        print(ratio)


def recorded(steps: int) -> Log:
    """Inputs (N, 4), and at the end of each stretch the readings of the markers near the mower."""
    random = np.random.default_rng(0)
    turn_rate = np.linspace(0.05, 0.2, steps)
    clean = np.column_stack([np.full((steps, 2), 0.01), turn_rate, np.full(steps, 0.01)])
    truth = stretch(FIRST, MOTION, clean).mean
    u = clean + random.normal(size=(steps, 4)) * (WHEEL, WHEEL, 1e-3, 0.0)
    readings = []
    for pose in truth[EVERY - 1 :: EVERY]:
        seen = []
        for ahead in (0.3, -0.4)[:MARKERS]:
            place = pose[:2] + 6 * np.array([math.cos(pose[2] + ahead), math.sin(pose[2] + ahead)])
            sensor = MarkerAngles(float(place[0]), float(place[1]), HEIGHT, AZIMUTH, ELEVATION)
            seen.append((sensor, sensor.h(pose) + random.normal(size=2) * (AZIMUTH, ELEVATION)))
        readings.append(seen)
    return u, readings


def at_readings(log: Log) -> Array:
    """Our estimate after each instant with readings : (N, 3); that of every step stands in the
    stretches.
    """
    U, readings = log
    filter, belief, estimates = EKF(), FIRST, []
    for k, seen in enumerate(readings):
        beliefs = stretch(belief, MOTION, U[k * EVERY : (k + 1) * EVERY])
        belief = Gaussian(beliefs.mean[-1], beliefs.covariance[-1])
        for sensor, z in seen:
            belief, _ = filter.update(belief, sensor, z)
        estimates.append(belief.mean)
    return np.array(estimates)


def peer(log: Log) -> Callable[[], Array]:
    """The same with filterpy's ExtendedKalmanFilter."""
    from filterpy.kalman import ExtendedKalmanFilter

    U, readings = log
    inputs = U.tolist()
    wheels = np.eye(2) * WHEEL**2
    R = np.diag([AZIMUTH**2, ELEVATION**2])

    class Mower(ExtendedKalmanFilter):  # type: ignore[misc]
        def predict_x(self, u: Any = 0) -> None:
            left, right, ω, dt = u
            x, y, θ = self.x.tolist()
            way, middle = (left + right) / 2, θ + ω * dt / 2
            c, s, lever = math.cos(middle), math.sin(middle), way / (2 * WIDTH)
            self.x = np.array([x + way * c, y + way * s, math.remainder(θ + ω * dt, 2 * math.pi)])
            self.F = np.array([[1.0, 0.0, -way * s], [0.0, 1.0, way * c], [0.0, 0.0, 1.0]])
            B = np.array(
                [
                    [c / 2 + lever * s, c / 2 - lever * s],
                    [s / 2 - lever * c, s / 2 + lever * c],
                    [-1 / WIDTH, 1 / WIDTH],
                ]
            )
            self.Q = B @ wheels @ B.T + Q

    def residual(z: Array, h: Array) -> Array:
        return np.array([math.remainder(z[0] - h[0], 2 * math.pi), z[1] - h[1]])

    def run() -> Array:
        mower, estimates = Mower(dim_x=3, dim_z=2), []
        mower.x, mower.P, mower.R = FIRST.mean.copy(), FIRST.covariance.copy(), R
        for k, seen in enumerate(readings):
            for u in inputs[k * EVERY : (k + 1) * EVERY]:
                mower.predict(u)
            for sensor, z in seen:
                mower.update(
                    z, lambda x, sensor=sensor: sensor.linearize(x)[1], sensor.h, residual=residual
                )
            estimates.append(mower.x)
        return np.array(estimates)

    return run


if __name__ == "__main__":
    main()

#!/usr/bin/env bash
# Guess:     an unscented filter of a linear robot, handed the noise of each step as Qs, smooths a log as the linear one
#            does with the same list: a robot that drives and then stands is smoothed to its drive.
# Behaviour: filterpy's UnscentedKalmanFilter.rts_smoother takes Qs, looks at none, and uses the filter's Q for every
#            step, which is that of the last step of the log. A log that ends at rest (Q = 0) is smoothed to one place:
#            six means of 1.82 m, each known to 0.47 m, where the linear one drives from 0.68 to 1.82 m. One that starts
#            at rest is smoothed as if it had driven there, too. Nothing is said: Qs of nonsense give the same. Right:
#            step by step, from the last, with the filter's Q set to that of the step: the linear smoother's numbers.
# Version:   filterpy 2.0.0 (PyPI)
# Source:    run below; rts_smoother fills Qs if None and then hands self.Q to the transform; rlabbe/filterpy#287, #279
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q filterpy==2.0.0 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from filterpy.kalman import KalmanFilter, MerweScaledSigmaPoints, UnscentedKalmanFilter

READINGS = (0.3, 1.1, 1.4, 2.4, 1.9, 2.2)
DRIVES, STANDS = np.eye(1), np.zeros((1, 1))
LOGS = {"drives, then stands": (DRIVES,) * 3 + (STANDS,) * 3, "stands, then drives": (STANDS,) * 3 + (DRIVES,) * 3}


def unscented():
    points = MerweScaledSigmaPoints(1, 1.0, 2.0, 2.0)
    return UnscentedKalmanFilter(1, 1, 1.0, hx=lambda x: x, fx=lambda x, dt: x, points=points)


def linear():
    filter = KalmanFilter(1, 1)
    filter.F, filter.H = np.eye(1), np.eye(1)
    return filter


def filtered(filter, noises):
    """The filter, and its means and covariances over the log; the noise of a step is set before its prediction."""
    filter.x, filter.P, filter.R = np.zeros(1), 4 * np.eye(1), np.eye(1)
    means, covariances = [], []
    for noise, reading in zip(noises, READINGS, strict=True):
        filter.Q = noise
        filter.predict()
        filter.update(reading)
        means.append(filter.x.copy())
        covariances.append(filter.P.copy())
    return filter, np.array(means), np.array(covariances)


def by_single_steps(filter, means, covariances, noises):
    """Smoothed from the last step to the first, the filter's Q set to that of each."""
    means, covariances = means.copy(), covariances.copy()
    for step in reversed(range(len(means) - 1)):
        filter.Q, two = noises[step + 1], slice(step, step + 2)
        means[two], covariances[two], _ = filter.rts_smoother(means[two], covariances[two])
    return means, covariances


def shown(name, smoothed):
    means, sigmas = np.ravel(smoothed[0]), np.sqrt(np.ravel(smoothed[1]))
    print(f"  {name:26s}", *(f"{mean:5.2f} ± {sigma:.2f}" for mean, sigma in zip(means, sigmas, strict=True)))
    return np.array([means, sigmas])


seen = {}
for log, noises in LOGS.items():
    print(f"{log}: smoothed place (m)")
    line, *run = filtered(linear(), noises)
    curve, *same = filtered(unscented(), noises)
    forward = np.allclose(run[0], same[0]) and np.allclose(run[1], same[1])
    seen[log] = (
        shown("linear, with Qs", line.rts_smoother(*run, Qs=noises)[:2]),
        shown("unscented, with Qs", curve.rts_smoother(*same, Qs=noises)[:2]),
        shown("unscented, Qs of nonsense", curve.rts_smoother(*same, Qs=(99 * DRIVES,) * 6)[:2]),
        shown("linear, the last Q for all", line.rts_smoother(*run, Qs=noises[-1:] * 6)[:2]),
        shown("unscented, step by step", by_single_steps(curve, *same, noises)),
        forward,
    )
alike = all(forward and np.allclose(step, told) for told, *_, step, forward in seen.values())
unread = all(
    np.allclose(given, nonsense) and np.allclose(given, last) and not np.allclose(given, told, atol=0.05)
    for told, given, nonsense, last, _, _ in seen.values()
)
told, given = seen["drives, then stands"][:2]
one_place = np.allclose(given, [[1.82], [0.47]], atol=0.01) and told[0][0] < 0.7 and told[1][0] > 0.7
raise SystemExit(0 if alike and unread and one_place else "this has changed")
PYTHON

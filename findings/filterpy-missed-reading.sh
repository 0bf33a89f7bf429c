#!/usr/bin/env bash
# Guess:     update(None), for a reading that did not come, gives no NIS, and no say in which of two filters is right.
# Behaviour: filterpy's KalmanFilter has a NIS of 0 then and the best likelihood there is, that of a reading just as
#            predicted; its extended and its unscented filter have those of the last reading once more. Over a log with
#            every second reading lost a right KalmanFilter has a mean NIS of 0.5 and looks too cautious. An
#            IMMEstimator weighs its filters by these likelihoods, though its manual has it that None changes nothing:
#            a reading of 6 m rules out the filter of 0.1 m for the one of 1 m, and five that do not come restore the
#            former to 99 %, whose peak is the higher. Right: where no reading came, call no update and count no NIS.
# Version:   filterpy 2.0.0 (PyPI)
# Source:    run below; update sets y to zeros in KalmanFilter, leaves y and S in the others, clears the kept distance
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q filterpy==2.0.0 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from filterpy.kalman import (
    ExtendedKalmanFilter,
    IMMEstimator,
    KalmanFilter,
    MerweScaledSigmaPoints,
    UnscentedKalmanFilter,
)

ONE, SIGMA_POINTS = np.eye(1), MerweScaledSigmaPoints(1, 1.0, 2.0, 2.0)


def started(filter, read_to=1.0):
    """A filter of one place that stands still, known to 1 m."""
    filter.x, filter.P, filter.Q, filter.R = np.zeros_like(filter.x), ONE.copy(), 0 * ONE, read_to**2 * ONE
    return filter


def linear(read_to=1.0):
    filter = started(KalmanFilter(1, 1), read_to)
    filter.F, filter.H = ONE, ONE
    return filter, filter.update


def extended():
    filter = started(ExtendedKalmanFilter(1, 1))
    filter.F = ONE
    return filter, lambda z: filter.update(z, lambda x: ONE, lambda x: x)


def unscented():
    filter = started(UnscentedKalmanFilter(1, 1, 1.0, hx=lambda x: x, fx=lambda x, dt: x, points=SIGMA_POINTS))
    return filter, filter.update


def judged(kind, readings):
    filter, update = kind()
    for reading in readings:
        filter.predict()
        update(None if reading is None else np.array([reading]))
        yield filter.mahalanobis**2, float(filter.log_likelihood)


def of_the_sharp(readings, lost_too):
    """Probability of a filter that reads to 0.1 m, beside one of 1 m, after each; lost_too: those of None are made."""
    both = IMMEstimator([linear(0.1)[0], linear(1.0)[0]], [0.5, 0.5], np.array([[0.97, 0.03], [0.03, 0.97]]))
    for reading in readings:
        both.predict()
        if lost_too or reading is not None:
            both.update(reading)
        yield both.mu[0].item()


KINDS = {"KalmanFilter": linear, "Extended": extended, "Unscented": unscented}
print("NIS (log-likelihood) of readings: 4 m, none, none, 1 m")
told = {}
for name, kind in KINDS.items():
    told[name] = np.array(list(judged(kind, (4.0, None, None, 1.0))))
    print(f"{name:14s}" + "".join(f"{nis:8.3f} ({log:6.3f})" for nis, log in told[name]))
draws = np.random.default_rng(1)
log = [draws.normal() if step % 2 else None for step in range(1, 4001)]
means = {name: np.mean([nis for nis, _ in judged(kind, log)]) for name, kind in KINDS.items()}
print("mean NIS, every second reading lost:", *(f"{name} {mean:.2f}" for name, mean in means.items()))
sharp, left_out = (list(of_the_sharp([0.5, 6.0] + [None] * 6, lost_too)) for lost_too in (True, False))
print("the filter of 0.1 m has, after 0.5 m, 6 m, six times none:", *(f"{each:.3f}" for each in sharp))
print("without those six updates:                                ", *(f"{each:.3f}" for each in left_out))
first = np.array([8.0, -4.0 - 0.5 * np.log(2 * np.pi * 2.0)])
nothing = first + [-8.0, 4.0]
linear_best = np.allclose(told["KalmanFilter"][:3], [first, nothing, nothing])
repeated = all(np.allclose(told[name][:3], [first] * 3) for name in ("Extended", "Unscented"))
halved = np.allclose([means[name] for name in KINDS], (0.5, 1.0, 1.0), rtol=0.1)
turned = sharp[1] < 1e-4 and sharp[-1] > 0.98 and left_out[-1] < 1e-4
raise SystemExit(0 if linear_best and repeated and halved and turned else "this has changed")
PYTHON

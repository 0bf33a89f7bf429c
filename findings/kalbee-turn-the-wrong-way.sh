#!/usr/bin/env bash
# Guess:     a robot that drove 10 m straight ahead, its heading known to 0.1 rad, and is read 1 m to the left of where
#            it thinks it is, had its heading too far to the right: an invariant filter turns it left, by 5.7 degrees.
# Behaviour: kalbee's InvariantEKF turns it right by 5.7 degrees, leaves its place where it was, at (10, 0), as if there
#            had been no reading, and claims to know the heading to 0.6 degrees. The same reading once more turns it
#            further. Of 1000 right starts and readings the mean NEES of the heading is 400 where 1 is right, and the
#            heading is off by 11 degrees where it was off by 6 before the reading. Right: for the error it corrects,
#            exp(xi) in front of the pose, a step leaves xi as it is, and a reading sees xi's turn, too, by its arm.
# Version:   kalbee 1.0.0 (PyPI)
# Source:    run below, beside both rules; predict puts the step's adjoint around the covariance, update's H has no arm
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q kalbee==1.0.0 numpy==2.4.6 2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from kalbee import SE3, InvariantEKF

METRES, HEADING, READ, ALMOST = 10.0, 0.1, 0.1, 1e-4
P, R = np.diag([ALMOST**2] * 5 + [HEADING**2]), READ**2 * np.eye(3)
METRE_AHEAD = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def degrees(pose):
    return np.degrees(np.arctan2(pose[1, 0], pose[0, 0]))


def driven():
    """The library's filter of a robot that starts at the origin, faces along x and drives straight ahead, exactly."""
    filter = InvariantEKF(np.eye(4), P, np.zeros((6, 6)), R)
    for _ in range(round(METRES)):
        filter.predict(1.0, METRE_AHEAD)
    return filter


def by_library(readings):
    """Pose, and standard deviation of the heading in degrees."""
    filter = driven()
    for reading in readings:
        filter.update(reading)
    return filter.pose, np.degrees(np.sqrt(filter.covariance[5, 5]))


def by_rule(readings):
    """The same of the error xi of exp(xi) @ pose: a place (x, y, z) is off by rho + phi x (x, y, z)."""
    pose, covariance = SE3.exp(METRES * METRE_AHEAD), P
    for reading in readings:
        x, y, z = place = pose[:3, 3]
        H = np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])
        K = covariance @ H.T @ np.linalg.inv(H @ covariance @ H.T + R)
        pose, covariance = SE3.exp(K @ (reading - place)) @ pose, (np.eye(6) - K @ H) @ covariance
    return pose, np.degrees(np.sqrt(covariance[5, 5]))


left = np.array([METRES, 1.0, 0.0])
turned = {}
print("read 1 m to the left           turned left by (degrees)   place (m)")
for name, way in (("library", by_library), ("rule", by_rule)):
    for times in (1, 2):
        pose, sigma = turned[name, times] = way([left] * times)
        x, y = pose[:2, 3]
        print(f"  {name:8s} {times} reading(s){degrees(pose):20.2f} ± {sigma:.2f}{x:16.2f}{y:6.2f}")
draws = np.random.default_rng(1)
errors = {"library": [], "rule": []}
for _ in range(1000):
    heading = draws.normal(0.0, HEADING)
    truth = METRES * np.array([np.cos(heading), np.sin(heading), 0.0])
    reading = truth + draws.normal(0.0, READ, 3)
    for name, way in (("library", by_library), ("rule", by_rule)):
        pose, sigma = way([reading])
        errors[name].append((degrees(pose) - np.degrees(heading), sigma))
print("1000 right starts and readings:  heading off by (degrees)  mean NEES of the heading")
nees, off = {}, {}
for name, each in errors.items():
    error, sigma = np.transpose(each)
    nees[name], off[name] = np.mean((error / sigma) ** 2), np.sqrt(np.mean(error**2))
    print(f"  {name:8s}{off[name]:32.2f}{nees[name]:20.2f}")
once, twice, rule = (turned[key] for key in (("library", 1), ("library", 2), ("rule", 1)))
wrong_way = np.isclose(degrees(once[0]), -5.7, atol=0.1) and degrees(twice[0]) < degrees(once[0])
still = np.allclose(once[0][:3, 3], [METRES, 0.0, 0.0], atol=0.02) and once[1] < 0.6
right = np.isclose(degrees(rule[0]), 5.7, atol=0.1) and rule[0][1, 3] > 0.97 and 0.85 < nees["rule"] < 1.15
raise SystemExit(0 if wrong_way and still and right and nees["library"] > 200 else "this has changed")
PYTHON

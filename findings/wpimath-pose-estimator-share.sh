#!/usr/bin/env bash
# Guess:     a pose estimator that is told standard deviations of its wheels, 0.1 m, and of a camera, 0.5 m, follows the
#            camera more after 1 km by wheels than after 1 cm, and the second of two readings less than the first.
# Behaviour: wpimath's estimator, told to wrap an Unscented Kalman Filter, has no covariance. The camera's share is
#            always q / (q + r) of the two standard deviations, 1/6, not q² / (q² + r²), 1/26: after 1 cm, 1 m and 1 km,
#            and for the tenth reading of a robot that stands still as for the first: ten readings count for 84 %.
# Version:   robotpy-wpimath 2026.2.2 (PyPI), DifferentialDrivePoseEstimator
# Source:    run below; its docstring, and the root of q / r in the gain of a steady filter
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q robotpy-wpimath==2026.2.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from wpimath.estimator import DifferentialDrivePoseEstimator
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import DifferentialDriveKinematics

WHEELS, CAMERA = 0.1, 0.5
SHARE = WHEELS / (WHEELS + CAMERA)


def followed(metres, readings=1):
    """How far the pose follows a camera that sees the robot 1 m beside where its wheels have brought it."""
    estimator = DifferentialDrivePoseEstimator(
        DifferentialDriveKinematics(1.0), Rotation2d(), 0, 0, Pose2d(), (WHEELS,) * 3, (CAMERA,) * 3
    )
    for step in range(1, 101):
        estimator.updateWithTime(step * 0.02, Rotation2d(), metres * step / 100, metres * step / 100)
    for reading in range(readings):
        now = 2.0 + 0.02 * reading
        estimator.updateWithTime(now, Rotation2d(), metres, metres)
        estimator.addVisionMeasurement(Pose2d(metres, 1.0, Rotation2d()), now)
    return estimator.getEstimatedPosition().Y()


after = {metres: followed(metres) for metres in (0.01, 1.0, 1000.0)}
standing = {readings: followed(0.01, readings) for readings in (1, 2, 10)}
for metres, share in after.items():
    print(f"after {metres:7.2f} m by wheels, one reading counts for {share:.4f}")
for readings, share in standing.items():
    print(f"standing still, {readings:2d} readings count for {share:.4f}")
constant = np.allclose(list(after.values()), SHARE)
never_less = all(np.isclose(share, 1 - (1 - SHARE) ** readings) for readings, share in standing.items())
raise SystemExit(0 if constant and never_less else "this has changed")
PYTHON

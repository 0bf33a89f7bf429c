#!/usr/bin/env bash
# Guess:     a Kalman filter of variance 1 that gets readings of variance 1 at one instant has variance 1/2, 1/3, 1/4
#            after them, in any library; and a reading weighs more after 1 km by wheels than after 1 cm.
# Behaviour: OpenCV's correct starts from the last prediction each time: of several readings of an instant only the last
#            one counts. Before the first predict that prediction is 0 with variance 0, so the reading counts for
#            nothing and the filter is certain. It also works in the arrays handed to it: the belief that the caller
#            keeps for comparison, and every one that he reads and keeps later, become the last belief.
#            wpimath's filters divide the variance of a reading by the seconds since the last prediction: with
#            "standard deviations of measurements" of 1 and the 0.02 s of a robot's loop a reading weighs as one of
#            7. Its pose estimator, told to wrap an Unscented Kalman Filter, has no covariance: the share of a camera
#            is q / (q + r) of two standard deviations, not q² / (q² + r²), and the same after 1 cm as after 1 km.
# Version:   opencv-python-headless 5.0.0.93, robotpy-wpimath 2026.2.2 (PyPI)
# Source:    run below; OpenCV's KalmanFilter::correct, wpimath's docstrings (estimator)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q opencv-python-headless==5.0.0.93 robotpy-wpimath==2026.2.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import cv2
import numpy as np
from wpimath.estimator import DifferentialDrivePoseEstimator, ExtendedKalmanFilter_1_1_1, KalmanFilter_1_1_1
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import DifferentialDriveKinematics
from wpimath.system import LinearSystem_1_1_1

ONE, NOTHING, READINGS = np.eye(1), np.zeros((1, 1)), (6.0, 2.0, 4.0)


def opencvs(x, P):
    filter = cv2.KalmanFilter(1, 1, 0, cv2.CV_64F)
    filter.transitionMatrix, filter.processNoiseCov = ONE.copy(), NOTHING.copy()
    filter.measurementMatrix, filter.measurementNoiseCov = ONE.copy(), ONE.copy()
    filter.statePost, filter.errorCovPost = x, P
    return filter


def opencv():
    filter = opencvs(NOTHING.copy(), ONE.copy())
    filter.predict()
    for reading in READINGS:
        filter.correct(np.array([[reading]]))
        yield filter.statePost.item(), filter.errorCovPost.item()


def wpimaths(filter, seconds):
    filter.predict(np.zeros(1), seconds)
    filter.setXhat(np.zeros(1))
    filter.setP(ONE)
    for reading in READINGS:
        filter.correct(np.zeros(1), np.array([reading]))
        yield np.ravel(filter.xhat()).item(), np.ravel(filter.P()).item()


def linear(seconds):
    return wpimaths(KalmanFilter_1_1_1(LinearSystem_1_1_1(NOTHING, ONE, ONE, NOTHING), [1.0], [1.0], 0.02), seconds)


def extended(seconds):
    return wpimaths(ExtendedKalmanFilter_1_1_1(lambda x, u: u * 0, lambda x, u: x, [1.0], [1.0], 0.02), seconds)


def share_of_camera(metres, wheels, camera):
    """How far the pose follows a camera that sees the robot 1 m beside where its wheels have brought it."""
    estimator = DifferentialDrivePoseEstimator(
        DifferentialDriveKinematics(1.0), Rotation2d(), 0, 0, Pose2d(), (wheels,) * 3, (camera,) * 3
    )
    for step in range(1, 101):
        estimator.updateWithTime(step * 0.02, Rotation2d(), metres * step / 100, metres * step / 100)
    estimator.addVisionMeasurement(Pose2d(metres, 1.0, Rotation2d()), 2.0)
    return estimator.getEstimatedPosition().Y()


told = {"by the book": [(sum(READINGS[:n]) / (1 + n), 1 / (1 + n)) for n in (1, 2, 3)], "OpenCV": list(opencv())}
for seconds in (1.0, 0.02):
    told[f"wpimath KF, {seconds} s"] = list(linear(seconds))
    told[f"wpimath EKF, {seconds} s"] = list(extended(seconds))
print("mean and variance after readings 6, 2, 4 of one instant")
for name, beliefs in told.items():
    print(f"{name:20s}" + "".join(f"{mean:10.3f} {variance:6.3f}" for mean, variance in beliefs))
early = opencvs(NOTHING.copy(), ONE.copy())
early.correct(np.array([[6.0]]))
print(f"OpenCV, a reading before the first predict: {early.statePost.item()}, variance {early.errorCovPost.item()}")
mine = NOTHING.copy(), ONE.copy()
filter = opencvs(*mine)
filter.predict()
kept = [(filter.correct(np.array([[reading]])), filter.errorCovPost) for reading in READINGS]
print(f"the caller's own belief was 0.0, 1.0, is {mine[0].item()}, {mine[1].item()}; kept {[x.item() for x, P in kept]}")
shares = [share_of_camera(metres, 0.1, 0.5) for metres in (0.01, 1.0, 1000.0)]
print("share of a camera of 0.5 m beside wheels of 0.1 m, after 1 cm, 1 m, 1 km:", *(f"{share:.4f}" for share in shares))
seen = {name: np.allclose(beliefs, told["by the book"]) for name, beliefs in told.items()}
right = {name for name, agrees in seen.items() if agrees} == {"by the book", "wpimath KF, 1.0 s", "wpimath EKF, 1.0 s"}
slow = np.allclose([told[f"wpimath {name}, 0.02 s"][0][1] for name in ("KF", "EKF")], 50 / 51)
last = np.allclose(told["OpenCV"], [(reading / 2, 0.5) for reading in READINGS])
certain = early.statePost.item() == early.errorCovPost.item() == 0
shared = [x.item() for x in (*mine, *(x for x, P in kept))] == [2.0, 0.5, 2.0, 2.0, 2.0]
raise SystemExit(0 if right and slow and last and certain and shared and np.allclose(shares, 0.1 / 0.6) else "this has changed")
PYTHON

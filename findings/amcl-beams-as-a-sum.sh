#!/usr/bin/env bash
# Guess:     of a robot in a square hall, known to 0.4 m and 0.1 rad, 180 beams read to 0.2 m tell far more than 8 do,
#            and one scan of them leaves 2 cm: a particle's weight is the product of its beams' likelihoods.
# Behaviour: it is 1 plus the sum of their cubes, as in ROS' likelihood_field. One scan of 180 beams leaves 0.32 m, one
#            of 8 beams 0.36 m; the same scan ten times over leaves 0.06 m, though it is one reading. sigma_hit is not
#            the sensor's sigma, then, and the cloud's spread says how many scans came, not how good they are: beside
#            an EKF of the same beams amcl looks far too cautious. Right: judge no such cloud by its spread, as by NEES;
#            ROS itself has likelihood_field_prob, too, a product of likelihoods, which this package has not.
# Version:   amcl 0.1.2 (PyPI), bindings of code adapted from nav2_amcl
# Source:    run below, beside both rules on draws of our own; ros-planning/navigation#1185, Ekumen-OS/beluga#153
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q amcl==0.1.2 numpy==2.4.6 2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import amcl
import numpy as np

HALF, CELL, FARTHEST, SIGMA, HIT, RANDOM = 5.0, 0.05, 12.0, 0.2, 0.95, 0.05
START = np.array([0.4, 0.4, 0.1])
CELLS = round(2 * HALF / CELL) + 1
MAP = np.full((CELLS, CELLS), 100)
MAP[1:-1, 1:-1] = 0


def scan(beams):
    """Bearings and exact ranges from the middle of the hall."""
    bearings = 2 * np.pi * np.arange(beams) / beams - np.pi
    return bearings, HALF / np.maximum(np.abs(np.cos(bearings)), np.abs(np.sin(bearings)))


def cloud(beams, scans):
    """Standard deviations (m, m, rad) of the particles of a robot that stands still, after so many equal scans."""
    laser = amcl.LaserParameters(
        z_hit=HIT, z_rand=RANDOM, z_short=0.0, z_max=0.0, sigma_hit=SIGMA,
        lambda_short=0.1, chi_outlier=0.0, max_beams=beams,
    )  # fmt: skip
    still = amcl.MotionParameters(0.0, 0.0, 0.0, 0.0, 0.0)
    localizer = amcl.AMCL(5000, 5000, 0.0, 0.0, still, laser, "differential")
    corner = -HALF - CELL / 2
    localizer.set_map(amcl.create_occupancy_grid_from_list(MAP.tolist(), CELL, corner, corner))
    localizer.set_laser_pose(amcl.Vector3D(0.0, 0.0, 0.0))
    localizer.set_initial_pose(amcl.Vector3D(0.0, 0.0, 0.0), amcl.create_diagonal_covariance(*map(float, START**2)))
    bearings, ranges = scan(beams)
    readings = amcl.create_laser_scan_from_list(np.transpose([ranges, bearings]).tolist(), FARTHEST)
    for _ in range(scans):
        localizer.update(readings, amcl.Vector3D(0.0, 0.0, 0.0))
    return np.sqrt(np.diag(localizer.get_pose_covariance().to_list()))


def by_rule(beams):
    """The same after one scan, by the product of the likelihoods and by 1 plus the sum of their cubes."""
    poses = np.random.default_rng(1).normal(size=(100_000, 3)) * START
    logarithms, cubes = np.zeros(len(poses)), np.ones(len(poses))
    for bearing, along in zip(*scan(beams), strict=True):
        facing = poses[:, 2] + bearing
        ends = [poses[:, 0] + along * np.cos(facing), poses[:, 1] + along * np.sin(facing)]
        off = np.min(np.abs(HALF - np.abs(ends)), axis=0)
        likelihood = HIT * np.exp(-(off**2) / (2 * SIGMA**2)) + RANDOM / FARTHEST
        logarithms += np.log(likelihood)
        cubes += likelihood**3
    for weights in (np.exp(logarithms - logarithms.max()), cubes):
        yield np.sqrt(np.average((poses - np.average(poses, axis=0, weights=weights)) ** 2, axis=0, weights=weights))


print("known along x to (m): before  one scan  ten scans     one scan by product  by 1 + sum of cubes")
seen = []
for beams in (8, 60, 180):
    product, cubes = by_rule(beams)
    before, once, tenfold = (cloud(beams, scans) for scans in (0, 1, 10))
    seen.append((before[0], once[0], tenfold[0], product[0], cubes[0]))
    print(f"{beams:4d} beams" + "{:18.3f}{:10.3f}{:11.3f}{:24.3f}{:21.3f}".format(*seen[-1]))
before, once, tenfold, product, cubes = np.transpose(seen)
started = np.allclose(before, 0.4, rtol=0.06)
a_sum = np.allclose(once, cubes, rtol=0.08) and once[-1] > 10 * product[-1]
sharper = (tenfold < 0.4 * once).all()
raise SystemExit(0 if started and a_sum and sharper else "this has changed")
PYTHON

#!/usr/bin/env bash
# Guess:     the poses that are made of KITTI's OXTS fixes are metres about the first one: over 5 km a straight road is
#            5 km long, to some centimetres, whichever way it goes, and ends where it leads to.
# Behaviour: pykitti draws them on a Mercator map of a sphere, stretched for the first latitude. At 49 degrees 5 km to
#            the east are 4990.5 m, to the north 5007.2 m: 9.5 m and 7.2 m off, where a GNSS fix is good to a few; a
#            road to the north-east is right in length and bent by 0.07 degrees, 5.7 m. An odometry that is right to
#            0.1 % is told a scale that depends on its course. pymap3d's plane about the first fix, by the ellipsoid,
#            is right to 1 cm here. Right: take latitude and longitude from the same packets.
# Version:   pykitti 0.3.1, pymap3d 3.2.0, pyproj 3.7.2 (PyPI)
# Source:    run below; pykitti.utils.pose_from_oxts_packet, earth radius 6378137 m in either direction; pyproj.Geod
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q pykitti==0.3.1 pymap3d==3.2.0 pyproj==3.7.2 \
  opencv-python-headless==5.0.0.93 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
cd "$folder"
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
import pymap3d
from pykitti.utils import load_oxts_packets_and_poses
from pyproj import Geod

LATITUDE, LONGITUDE, ROAD = 49.0, 8.4, 5000.0


def by_pykitti(latitudes, longitudes):
    with open("oxts.txt", "w") as file:
        for place in zip(latitudes, longitudes):
            numbers = [*place, *[0.0] * 23]  # height, angles, velocities, accelerations, rates, accuracies
            file.write(" ".join(f"{number:.12f}" for number in numbers) + " 4 8 5 5 5\n")
    return load_oxts_packets_and_poses(["oxts.txt"])[-1].T_w_imu[:2, 3]


def by_pymap3d(latitudes, longitudes):
    east, north, _ = pymap3d.geodetic2enu(latitudes[-1], longitudes[-1], 0.0, latitudes[0], longitudes[0], 0.0)
    return np.array([east, north])


agrees = []
print("a road of 5000 m to the     library     length (m)    bent (degrees)    its end is off (m)")
for course, expected in ((0, 7.18), (45, 5.70), (90, 9.82)):
    end_longitude, end_latitude, _ = Geod(ellps="WGS84").fwd(LONGITUDE, LATITUDE, course, ROAD)
    true = ROAD * np.array([np.sin(np.radians(course)), np.cos(np.radians(course))])
    for name, library in (("pykitti", by_pykitti), ("pymap3d", by_pymap3d)):
        end = library([LATITUDE, end_latitude], [LONGITUDE, end_longitude])
        bent, off = np.degrees(np.arctan2(*end)) - course, np.linalg.norm(end - true)
        print(f"{course:25d}°{name:>12s}{np.linalg.norm(end):15.2f}{bent:18.3f}{off:22.2f}")
        agrees.append(abs(off - expected) < 0.05 if name == "pykitti" else off < 0.01)
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON

#!/usr/bin/env bash
# Guess:     a track and the ROS map that it was driven in lie on each other in evo's plot, whatever the map's origin
#            is: [x, y, yaw], the pose of the picture's lower left corner.
# Behaviour: only where the yaw is 0. evo moves the picture by x, y first and turns it about the map's (0, 0) then, so
#            that its corner is turned along: an origin of [10, 20, 90°] puts it at (-20, 10). The picture's heading is
#            right, and at 5 degrees it is 2 m off, so that the robot looks badly localized. Right: for evo alone, a
#            copy of the yaml whose x, y are the corner's turned back by the yaw.
# Version:   evo 1.38.1, matplotlib 3.11.2 (PyPI)
# Source:    run below; evo.tools.plot.ros_map, translate before rotate; the map format's "2-D pose of the lower-left
#            pixel", wiki.ros.org/map_server
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q evo==1.38.1 matplotlib==3.11.2 pillow==13.0.0 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
cd "$folder"
HOME=$folder MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import matplotlib.pyplot as plt
import numpy as np
from evo.tools.plot import PlotMode, ros_map
from PIL import Image

Image.fromarray(np.full((20, 40), 254, np.uint8)).save("map.pgm")
CORNER = np.array([10.0, 20.0])


def turned(place, yaw):
    return np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]) @ place


def drawn(corner, yaw):
    """Where the plot has the lower left corner of the picture, and the heading of its lower edge."""
    with open("map.yaml", "w") as file:
        file.write(f"image: map.pgm\nresolution: 0.05\norigin: [{corner[0]}, {corner[1]}, {yaw}]\n")
        file.write("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")
    axes = plt.figure().gca()
    ros_map(axes, "map.yaml", PlotMode.xy)
    [picture] = axes.images
    left, right, bottom, _ = picture.get_extent()
    low_left, low_right = (picture.get_transform() - axes.transData).transform([(left, bottom), (right, bottom)])
    return low_left, np.arctan2(*(low_right - low_left)[::-1])


agrees = []
print("origin in the yaml: corner (10, 20); yaw     corner in the plot     heading of the edge")
for degrees in (0, 5, 90):
    yaw = np.radians(degrees)
    corner, heading = drawn(CORNER, yaw)
    print(f"{degrees:40d}°{corner[0]:14.3f} {corner[1]:8.3f}{np.degrees(heading):22.1f}°")
    agrees.append(np.allclose(corner, turned(CORNER, yaw)) and np.isclose(heading, yaw))
    mended, _ = drawn(turned(CORNER, -yaw), yaw)
    agrees.append(np.allclose(mended, CORNER))
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON

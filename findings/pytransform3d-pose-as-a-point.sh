#!/usr/bin/env bash
# Guess:     the ellipsoid that is drawn for an uncertain pose shows how well its place is known, 0.1 m all round, be
#            its heading known well or badly, and be lengths metres or centimetres.
# Behaviour: of the six directions of the covariance pytransform3d takes the three of the greatest variance, square
#            radians among square metres, and draws where these lead. A pose known to 0.3 rad about each axis is drawn
#            as a single point; one known to 0.3 rad about the vertical alone as a flat disc, that has lost the
#            direction in which the place is known best; the same two in centimetres as the ellipsoid. Right: cut the
#            3 × 3 block of the place out and give it to to_ellipsoid.
# Version:   pytransform3d 3.17.0 (PyPI)
# Source:    run below; to_projected_ellipsoid sorts the eigenvalues of the 6 × 6 matrix and keeps three
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q pytransform3d==3.17.0 scipy==1.17.1 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pytransform3d.uncertainty import to_projected_ellipsoid

PLACE = (0.10, 0.11, 0.09)
TURNS = {
    "0.01 rad about each axis": (0.01, 0.01, 0.01),
    "0.3 rad about z": (0.01, 0.01, 0.3),
    "0.3 rad about each": (0.3, 0.3, 0.3),
}


def reach(turns, unit):
    """How far the drawn ellipsoid of one standard deviation reaches along x, y and z, in metres; unit: metres."""
    sigmas = np.array([*turns, *(along / unit for along in PLACE)])
    drawn = to_projected_ellipsoid(np.eye(4), np.diag(sigmas**2), factor=1.0, n_steps=200)
    return np.array([np.abs(along).max() * unit for along in drawn])


print("a place known to", *PLACE, "m (x, y, z), drawn with lengths in")
print(f"{'':28s}{'metres':>17s}{'centimetres':>24s}")
told = {}
for name, turns in TURNS.items():
    told[name] = reach(turns, 1.0), reach(turns, 0.01)
    print(f"{name:26s}" + "   ".join("".join(f"{along:7.3f}" for along in drawn) for drawn in told[name]))
expected = {"0.01 rad about each axis": PLACE, "0.3 rad about z": (0.10, 0.11, 0.0), "0.3 rad about each": (0.0,) * 3}
as_told = all(np.allclose(told[name][0], sizes, atol=1e-3) for name, sizes in expected.items())
by_unit = all(np.allclose(told[name][1], PLACE, atol=1e-3) for name in TURNS)
raise SystemExit(0 if as_told and by_unit else "this has changed")
PYTHON

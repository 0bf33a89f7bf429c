#!/usr/bin/env bash
# Guess:     two hypotheses of a robot that differ by 2 degrees of heading are merged into one between them, 179 and
#            -179 into one near 180 as 89 and 91 into one near 90: the headings are Bearings, which fold.
# Behaviour: Stone Soup's GaussianMixtureReducer makes of 179 (weight 0.6) and -179 (0.4) one hypothesis at 36 degrees,
#            of two of equal weight one at 0, the opposite way. It takes them for near, as the difference of two
#            Bearings folds, and calls the result known to 2.2 degrees for the same reason; the mean is a sum of plain
#            numbers times their weights, and no Bearing any more. It is so only where the two lie on either side
#            of 180. The library's own mean of the same states is right. Right: merging=False, and that mean instead.
# Version:   stonesoup 1.9.1 (PyPI), GaussianMixtureReducer, Bearing; what it needs for plots is left out
# Source:    run below; merge_components' merged_mean, beside np.average of StateVectors, which asks Bearing.average
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --no-deps stonesoup==1.9.1 ordered-set==4.1.0 scipy==1.17.1 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from stonesoup.mixturereducer.gaussianmixture import GaussianMixtureReducer
from stonesoup.types.angle import Bearing
from stonesoup.types.array import CovarianceMatrix, StateVector, StateVectors
from stonesoup.types.state import WeightedGaussianState

SIGMA = 2.0
P = np.diag([0.01, 0.01, np.radians(SIGMA) ** 2])


def merged(headings, weights):
    """What the reducer leaves of hypotheses of one place: headings and standard deviations, in degrees."""
    poses = (StateVector([4.0, 2.0, Bearing(np.radians(heading))]) for heading in headings)
    each = [WeightedGaussianState(pose, CovarianceMatrix(P), weight=w) for pose, w in zip(poses, weights, strict=True)]
    mean = np.average(StateVectors([one.state_vector for one in each]), axis=1, weights=weights)
    left = GaussianMixtureReducer(merge_threshold=16).reduce(each)
    means = [np.degrees(float(one.state_vector[2, 0])) for one in left]
    sigmas = [np.degrees(np.sqrt(float(one.covar[2, 2]))) for one in left]
    return means, sigmas, type(left[0].state_vector[2, 0]) is Bearing, np.degrees(float(mean[2, 0]))


print("two hypotheses (degrees)   of weights      the reducer leaves     the library's own mean")
seen = {}
for pair, weights in [
    ((89, 91), (0.6, 0.4)),
    ((-1, 1), (0.6, 0.4)),
    ((179, -179), (0.6, 0.4)),
    ((179, -179), (0.5, 0.5)),
    ((178, -178), (0.75, 0.25)),
    ((30, -30), (0.6, 0.4)),
]:
    means, sigmas, folds, mean = seen[pair, weights] = merged(pair, weights)
    left = ", ".join(f"{m:.1f} ± {s:.1f}" for m, s in zip(means, sigmas, strict=True))
    print(f"{pair[0]:10d} {pair[1]:5d} {weights[0]:14.2f} {weights[1]:5.2f} {left:>27s} {mean:18.1f}")
sound = all(
    np.allclose((means[0], mean), right, atol=0.01) and len(means) == 1
    for right, (means, _, _, mean) in ((89.8, seen[(89, 91), (0.6, 0.4)]), (-0.2, seen[(-1, 1), (0.6, 0.4)]))
)
apart = len(seen[(30, -30), (0.6, 0.4)][0]) == 2
wild = all(
    np.allclose(seen[pair, weights][0], wrong) and seen[pair, weights][1][0] < 3 and not seen[pair, weights][2]
    for pair, weights, wrong in (
        ((179, -179), (0.6, 0.4), 35.8),
        ((179, -179), (0.5, 0.5), 0.0),
        ((178, -178), (0.75, 0.25), 89.0),
    )
)
own = abs(seen[(179, -179), (0.6, 0.4)][3]) > 179.7 and abs(seen[(178, -178), (0.75, 0.25)][3]) > 178.9
raise SystemExit(0 if sound and apart and wild and own else "this has changed")
PYTHON

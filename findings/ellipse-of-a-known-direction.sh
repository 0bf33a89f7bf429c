#!/usr/bin/env bash
# Guess:     a place that is known exactly across a line and to 0.2 m along it, as after a straight drive by odometry,
#            is drawn as that line, whichever way it points.
# Behaviour: for about every third degree of heading nothing is drawn at all, by Stone Soup's Plotter and Plotterly and
#            by GTSAM, and the place looks known exactly. The lesser eigenvalue of such a covariance is 0 but for
#            rounding, which makes it some -1e-18 as readily as 1e-18; its root, and so the ellipse, is nan (in Plotly's
#            every point), which no plot complains of: NumPy warns of a root, once. Which headings it is, is chance.
#            Right: 1e-12 m² more on the diagonal; eigenvalues of at least 0.
# Version:   stonesoup 1.9.1, plotly 7.1.0, gtsam 4.3.0, matplotlib 3.11.2 (PyPI)
# Source:    run below; np.sqrt of eigh's values in Plotter.plot_tracks, Plotterly._generate_ellipse_points and
#            gtsam.utils.plot.plot_covariance_ellipse_2d
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q stonesoup==1.9.1 plotly==7.1.0 gtsam==4.3.0 matplotlib==3.11.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import datetime

import gtsam.utils.plot
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse
from stonesoup.plotter import Plotter, Plotterly
from stonesoup.types.state import GaussianState
from stonesoup.types.track import Track

NOON, HEADINGS, ALONG = datetime.datetime(2026, 1, 1, 12), np.radians(np.arange(360)), 0.2


def covariances(across):
    ahead = np.stack([np.cos(HEADINGS), np.sin(HEADINGS)], axis=-1)
    return ALONG**2 * ahead[:, :, None] * ahead[:, None, :] + across * np.eye(2)


def track(beliefs):
    seconds = map(datetime.timedelta, np.arange(360) / 86400.0)
    return {Track([GaussianState(np.zeros((2, 1)), P, timestamp=NOON + s) for P, s in zip(beliefs, seconds)])}


def whole(axes):
    ellipses = [each for each in axes.get_children() if isinstance(each, Ellipse)]
    return [bool(np.isfinite([each.width, each.height]).all()) for each in ellipses]


def by_plotter(beliefs):
    plotter = Plotter()
    plotter.plot_tracks(track(beliefs), [0, 1], uncertainty=True)
    return whole(plotter.ax)


def by_plotterly(beliefs):
    plotter = Plotterly()
    plotter.plot_tracks(track(beliefs), [0, 1], uncertainty=True)
    filled = [each for each in plotter.fig.data if each.fill == "toself" and each.x[0] is not None]
    return [bool(np.isfinite(np.array([each.x, each.y], float)).all()) for each in filled]


def by_gtsam(beliefs):
    axes = plt.figure().gca()
    for P in beliefs:
        gtsam.utils.plot.plot_covariance_ellipse_2d(axes, np.zeros(2), P)
    return whole(axes)


agrees = []
print("ellipses drawn of 360, one a degree     known exactly across     1e-6 m across")
for name, draw in (("Stone Soup, Plotter", by_plotter), ("Stone Soup, Plotterly", by_plotterly), ("GTSAM", by_gtsam)):
    exact, nearly = draw(covariances(0.0)), draw(covariances(1e-12))
    print(f"{name:40s}{sum(exact):20d}{sum(nearly):18d}")
    agrees.append(len(exact) == len(nearly) == 360 and 36 <= sum(exact) <= 324 and all(nearly))
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON

#!/usr/bin/env bash
# Guess:     the "uncertainty" bars of a track in three dimensions are a standard deviation long, each along the axis
#            that it belongs to, and the two plotters of one library draw the same bars.
# Behaviour: Plotterly's are. Stone Soup's Plotter draws the eigenvalues of the covariance, square metres read as
#            metres, and in rising order: the least one always along x, the greatest along z. A place known to 2 m,
#            0.5 m and 0.1 m has bars of 0.01, 0.25 and 4 m, and looks known best where it is known worst; one known
#            to 0.1 m all round has bars of 0.01 m. In two dimensions both draw an ellipse of a standard deviation.
# Version:   stonesoup 1.9.1, plotly 7.1.0, matplotlib 3.11.2 (PyPI)
# Source:    run below; Plotter.plot_tracks takes x_err, y_err, z_err from eigh's values, Plotterly's from the diagonal,
#            as dstl/Stone-Soup#887, closed, would have had it in Plotter, too
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q stonesoup==1.9.1 plotly==7.1.0 matplotlib==3.11.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import datetime

import numpy as np
from matplotlib.patches import Ellipse
from stonesoup.plotter import Dimension, Plotter, Plotterly
from stonesoup.types.state import GaussianState
from stonesoup.types.track import Track

NOON = datetime.datetime(2026, 1, 1, 12)


def tracks(sigmas):
    return {Track([GaussianState(np.zeros((len(sigmas), 1)), np.diag(np.square(sigmas)), timestamp=NOON)])}


def matplotlib_bars(sigmas):
    """Half the length of the bar along x, y and z; what reaches no way along an axis is no bar of it."""
    plotter = Plotter(Dimension.THREE)
    plotter.plot_tracks(tracks(sigmas), [0, 1, 2], uncertainty=True)
    reach = [[np.ptp(np.asarray(along, float)) / 2 for along in line.get_data_3d()] for line in plotter.ax.lines]
    return np.max(reach, axis=0)


def plotly_bars(sigmas):
    plotter = Plotterly(Dimension.THREE)
    plotter.plot_tracks(tracks(sigmas), [0, 1, 2], uncertainty=True)
    drawn = [trace for trace in plotter.fig.data if trace.error_x.array is not None]
    return np.array([bars.array[0] for bars in (drawn[0].error_x, drawn[0].error_y, drawn[0].error_z)])


def ellipse_of_two(sigmas):
    plotter = Plotter()
    plotter.plot_tracks(tracks(sigmas), [0, 1], uncertainty=True)
    [ellipse] = [each for each in plotter.ax.get_children() if isinstance(each, Ellipse)]
    return ellipse.width / 2, ellipse.height / 2


agrees = [np.allclose(ellipse_of_two((2.0, 0.5)), (2.0, 0.5))]
print("metres along x, y, z        known to                Plotter              Plotterly")
for sigmas in ((2.0, 0.5, 0.1), (0.1, 0.5, 2.0), (0.1, 0.1, 0.1)):
    drawn, plotly = matplotlib_bars(sigmas), plotly_bars(sigmas)
    print(" " * 16 + "  ".join("".join(f"{along:7.2f}" for along in lengths) for lengths in (sigmas, drawn, plotly)))
    agrees += [np.allclose(drawn, sorted(np.square(sigmas))), np.allclose(plotly, sigmas)]
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON

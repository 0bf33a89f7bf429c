"""Angles, rays and ellipses: arrays in, arrays out. Nothing here knows what a robot is.

    angles.py    a direction in (−π, π]
    ellipse.py   from a covariance to what is drawn of it
    outline.py   how far a point is from a path
    meeting.py   what it means that a beam meets a wall
    walls.py
    a map's walls, and which of them a beam meets first; `brute_force` is all of it in twenty lines
    lanes.py     how the small matrices of many runs lie in memory
    backend.py   NumPy, or code compiled by Numba

Everything else is speed: ways to find by fewer trials what `brute_force` finds by trying every
wall. All of them give its ranges and its walls; tests/geometry/test_walls.py holds them to that.
Which one `Walls.cast` takes, the first that suits:

    very far from the map     walls.py
    `brute_force`: out there rounding is not small against a cell
    one beam, or few          grid.py      from cell to cell of a grid, in plain floats
    many, with Numba
    compiled.py  beam after beam from cell to cell, through the grids of cells.py
    many from one place       fan.py
    a scan: each wall is asked which beams its two ends enclose
    many close together       bundle.py
    runs of a study: only the walls before them all are tried, by broad.py
    many, and few walls       broad.py     all beams × all walls, as products of matrices
    many, and many walls      march.py
    all beams at once from cell to cell, through the grids of cells.py

How many is many, and how few is few, stands in capitals at the top of walls.py and bundle.py. Where
rounding could decide, compiled, fan, bundle and broad leave a beam in doubt, and march follows it
once more. pairs.py is the end that fan, broad and march share: what a few pairs of beam and wall
come to, by the rules of meeting.py.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]

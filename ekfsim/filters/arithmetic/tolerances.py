"""What is taken for rounding, and why."""

import numpy as np

# a difference below this share of what it is taken of is rounding: a handful of operations, each
# wrong by half of the last digit, and the cancelling of one number by another of its size
ROUNDING = 16 * float(np.finfo(float).eps)
# of Σ Hᵢ² Pᵢᵢ; a sensor of less noise leaves of P so little that the difference P − K H P has too
# few right digits: (1 − 1e-4) of a variance is taken from it, and four digits are gone
SHARP = 1e-4
# standard deviations; a step of the iterated filter's search that is shorter is the last. Steps
# shrink by squares near the end, so that the next would be rounding
CONVERGED = 1e-10

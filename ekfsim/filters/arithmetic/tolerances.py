"""What is taken for rounding, and why."""

import numpy as np

# a difference below this share of what it is taken of is rounding: so much a sum of a few products
# may be off
ROUNDING = 16 * float(np.finfo(float).eps)
# of Σ Hᵢ² Pᵢᵢ; where a sensor's noise is less, P − K H P may be a ten-thousandth of P: four of its
# digits are gone, and it is taken by square roots
SHARP = 1e-4
# standard deviations; a step of the iterated filter's search that is shorter is the last
CONVERGED = 1e-10

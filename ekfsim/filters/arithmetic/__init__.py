"""What the filters calculate with, where the textbook's formula is not what keeps digits.

square_root.py  P = L Lᵀ, and what a reading leaves of it: Carlson's update, which is K, too
unscented.py    sigma points: a mean and a covariance through any function
descent.py      the search of the iterated filter
algebra.py      symmetric, inverse; headings wrapped; the moments that judge particles
chi_square.py   quantiles of χ²
tolerances.py   what is taken for rounding, and why
"""

"""Which seeds there are: those that are one word of NumPy's SeedSequence.

It fills what it is given up with zeros, and takes a number of 2³² and more for two: [2³² + 7, 3]
would be [7, 1, 3], and a driven robot's run 0 of the seed 2³² + 7 the run 1 of the seed 7. A run's
number may be larger: it stands last, and its second word where no draw of a seed below 2³² has one.
"""

MOST_SEED = 2**32 - 1
REPEATS = "beyond it NumPy's seed words would repeat the draws of other seeds"

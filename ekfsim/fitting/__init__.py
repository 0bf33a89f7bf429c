"""The noises that suit a log: fitted to one half of it, and tried on the other.

noises.py      which numbers there are to be fitted, and a scene that is told others
likelihood.py  how likely the innovations of a log are under what the filter is told
abreast.py     many sets of numbers tried in one run of the filter
search.py      where the cost is least, and how far each number can be moved
estimate.py    the most likely numbers, with their intervals
trial.py       a log halved: fitted, and held against the half that was held back
written.py     a world and a commands file with the numbers, to be played at once
"""

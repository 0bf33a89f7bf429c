"""A belief of a few Gaussians.

mhekf.py    predict and update of each hypothesis
answers.py  how they part at a reading that may be of one wall or another
relocating.py  whether the robot was carried away, and where it may be then
places.py   the places for hypotheses: more of them, those of some runs, put together
merging.py  which of many Gaussians are one, and the moments of all together
"""

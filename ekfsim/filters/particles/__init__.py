"""Crowds of particles whose number varies; amcl draws its own of them.

kld.py      how many particles are enough for the bins that they lie in
roaming.py  such crowds, of many runs side by side
drawing.py  particles drawn anew, of each run: by weights, parted, some from anywhere
"""

"""A plan's blocks are done, on one machine or many, and kept as they are done.

engines.py     here, in processes of this machine, or on a cluster
cluster.py     on the workers of a Dask scheduler
journal.py     each finished block at once on disk
doing.py       what the journal lacks is done; then the sum of all
whole_runs.py  of which filters Numba compiles whole runs, and what is said of the others
"""

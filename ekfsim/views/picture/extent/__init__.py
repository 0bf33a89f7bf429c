"""How much of the plane is seen.

limits.py  a rectangle of the plane      reach.py  how far a run reaches
scope.py   what each view shows of it
"""

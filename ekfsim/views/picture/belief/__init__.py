"""What is drawn of a belief: what it says, what it said before, and whether the truth is outside.

belief.py   the estimate with its ellipse, its cone and its path, and the truth
shape.py    where the belief of a view is in the plane, found once for all Axes
warned.py   an area in its own colour, or in that of a warning while the truth is outside
ghost.py    the belief before this view's
ways.py     where the robot truly was, and where it would be by odometry alone
hypotheses.py  the ellipses of a belief that is several Gaussians
others.py   the filters that watch beside the first
"""

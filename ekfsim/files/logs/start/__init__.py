"""Where the filter of a recorded log begins, how sure it is of that, and what is said of it.

instant.py   at which instant: the first at which the truth, or the position, is known
belief.py    with which belief: the true pose, what somebody told, a fix, or the world's start
course.py    which way a robot looks whose position alone is read
words.py     the line that says what was assumed, and how to say otherwise
"""

"""Changes made, and what comes of them.

replaying.py  a scene with changes → its Steps     trials.py   one run, within a budget of replays
crowd.py      the same of many runs → shares       naming.py   which suspects it was, by both
minimal.py    the smallest set that cures (ddmin)  seeing.py   a direction that no beam sees
chance.py     how few runs are beyond a bound: bad luck
logs.py       one log, many changes side by side   log_trials.py, log_naming.py: the same of a log
"""

"""A student's code in a process of its own, which answers in plain numbers and can be killed.

    sandboxed.py   the caller whose code runs over there
    limits.py      what it may take
    folder.py      the folder that it runs in: a copy of what was handed in
    process.py     the process: begun, asked by a deadline, ended
    exchange.py    what goes over, to the byte
    told.py        motions, sensors and walls in plain numbers
    keeper.py      over there: who kills whatever the code started
    kernel.py      what Linux alone can do, and what a machine lacks
    answering.py   over there: who answers, whatever the code does
    calling.py     over there: the code, and what may be asked of it

What this protects from, and what it does not: docs/course/safety.md.
"""

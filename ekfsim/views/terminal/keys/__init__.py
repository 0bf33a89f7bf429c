"""Keys: where their bytes come from, what they are called, and what they ask for.

sources.py   bytes of a terminal, a console window, a pipe
keyboard.py  bytes → the name of a key
bindings.py  the name of a key → an action, and how often; help.py tells them
interrupts.py  Ctrl-C on a long way
"""

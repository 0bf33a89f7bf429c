"""A run that is driven at the keyboard, in `drive` and from `play` on.

keys.py    what each key asks for, told in help.py    driver.py  what comes of it
"""

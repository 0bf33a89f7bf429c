"""What is drawn in lines, outlines and circles → a Plan, in metres.

drawing.py   what a reader finds, shape after shape
units.py     what one of a drawing's coordinates is
earth.py     longitude and latitude as metres
curves.py    curves as lines within a tolerance
"""

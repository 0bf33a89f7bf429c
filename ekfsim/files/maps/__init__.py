"""Plans that other programs wrote → what a world file says. `ekfsim world` writes it.

plan.py      what every reader makes of a plan, and what it is asked
reading.py   which plan a file holds, and its reader
formats/     the readers, a file for each kind of plan
drawn/       what is drawn in lines, outlines and circles
json_text.py JSON, and places in it
standing.py  where a robot can start among its walls
holes.py     outlines with holes → outlines without
writing.py   a plan → the text of a world file
making.py    all of it, with the checks of a world file
signs.py     by what each kind is recognised
"""

"""What is to be read on a picture.

lettering.py  any text, made fit               outlined.py  text that changes, drawn fast
legend.py     what is seen in a view, named    samples.py   what stands for it there
names.py      of obstacles and landmarks       crossed.py   where lines run, for the names
"""

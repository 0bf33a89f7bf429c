"""Text ↔ objects, a room for each part of the way. Nothing heavy is imported here.

source.py   bytes → text                     keys/     what each kind of file may hold
yaml/       text → data, with its places     scenes/   data → World, Scene, study
logs/       recorded logs → entries          results/  steps → trace, tables, trajectories
maps/       plans of other programs → the text of a world file
packaged.py, looking.py   which files there are         foreign.py  what is no file of ours
template.py  files to start from      homework.py  what is graded
scene_text.py  Scene → the text of a commands file
"""

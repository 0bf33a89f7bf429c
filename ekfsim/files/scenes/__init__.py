"""World, commands and study files → scenes; all mistakes at once.

one_file, load, load_study    a file, a scene, a study
building                      keys → the world
playing                       keys → what is driven in it
logged                        a recording in place of commands
overruling, settings          what --set says instead
checking/                     what of them no schema can say
"""

"""What the schemas cannot say of world, commands and study files: each mistake with its place.

world_checks, polygons                          worlds
command_checks                                  lists of commands
sound                                           a file without what is known to be wrong
drive_checks, driven_checks, system_checks      drives, and robots that are driven
filter_checks                                   filters and their numbers
doubts                                          what is no mistake, and hardly meant
"""

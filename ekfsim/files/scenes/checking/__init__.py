"""What the schemas cannot say of world, commands and study files: each mistake with its place.

checks, polygons                                worlds and commands
drive_checks, driven_checks, system_checks      drives, and robots that are driven
filter_checks                                   filters and their numbers
doubts                                          what is no mistake, and hardly meant
"""

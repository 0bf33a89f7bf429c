"""How people see a run. Everything here is a function of Steps.

playback/   views, one for each press of `n`
words/      the narrative and its numbers    picture/   what matplotlib draws of a step
terminal/   a run at the keyboard            film/      frames, GIF, MP4
study/      what is told of many runs        student/     what is told of students' filters
worksheet/  the narrative with gaps
"""

"""How people see a run. Everything here is a function of Steps.

playback/   views, one for each press of `n`
driving/    a run whose commands come one by one
words/      the narrative and its numbers    picture/   what matplotlib draws of a step
curves/     a run over its steps             film/      frames, GIF, MP4
terminal/   a run at the keyboard            worksheet/ the narrative with gaps
page/       a run as one page for a browser  gallery/   all scenarios as a web site
notebook/   what a notebook shows
study/      what is told of many runs        student/   what is told of students' filters
fitting/    what is told of noises that were fitted to a log
"""

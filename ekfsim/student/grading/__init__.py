"""Submissions are graded by what a homework asks for.

submissions.py what was handed in          scores.py    points, which begin at 0 and "not run"
examining.py   one test of one submission  parts/       what is looked at, a file for each kind
bench.py       the runs and the reference  sound.py     whether a homework can be graded at all
crew.py        processes side by side      grading.py   all submissions, each kept at once
keeping.py     what a grade depends on     formats/     grades as files
                                           autograder/  the zip of Gradescope
"""

"""Commands of a course.

comparing.py   diff
students.py    mutants, worksheet
grading.py     grade, autograder
"""

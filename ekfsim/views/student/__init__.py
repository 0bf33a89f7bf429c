"""What is told of students' filters.

exposing.py      which known mistakes an input exposes
"""

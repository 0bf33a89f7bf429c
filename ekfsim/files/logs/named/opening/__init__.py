"""A file of a log for everybody → a table, its columns found, told apart and worked out.

opened.py   the names of a first line, or the places that a commands file tells
ragged.py   rows of several readings, and rows that are not equally long
derived.py  dates, latitude and longitude, quaternions → t, x, y, θ
ordered.py  rows without times go by their order
"""

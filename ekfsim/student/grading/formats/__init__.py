"""Grades as files: what a grader, a spreadsheet, a platform or a build server reads.

    table.py      grades.csv
    report.py     a submission in words
    class_page.py which mistakes the class made
    gradescope.py results.json of Gradescope
    junit.py      what build servers read
    inert.py      a student's words, made harmless for a page
    folder.py     all of them in a folder, whole or absent

Nothing here has a clock: the same homework and submissions make the same bytes.
"""

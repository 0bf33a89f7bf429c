"""The known mistakes of students' filters, and which of them a student's numbers are those of.

    working.py    a step of the EKF taken apart: every symbol from the others, each replaceable
    recalling.py  a model that works out once what many mistakes ask it for
    mistake.py    a mistake: what is told of it, what to read again, the pieces that it changes
    table/        the mistakes, by what they change
    known.py      the table of them all
    guessing.py   the mistakes, alone or two together, that reproduce a student's numbers
    mutant.py     a filter with one of the mistakes

Every mistake is made in a step from the belief that the student's own filter had before it.
"""

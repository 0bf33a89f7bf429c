"""The known mistakes of students' filters, and which of them a student's numbers are those of.

    working.py      a step of the EKF taken apart: every symbol from the others, each replaceable
    recalling.py    a model that works out once what many mistakes ask it for
    mistake.py      a mistake: what is told of it, what to read again, the pieces that it changes
    steps.py        the steps in which a mistake can be made
    of_moves.py     mistakes of the mean and of the input that a motion is predicted with
    of_slopes.py    mistakes of J_x and J_u
    of_noise.py     mistakes of P_u, and of what is made of P by a motion
    of_readings.py  mistakes of ν, J_H and C_v
    of_beams.py     mistakes of h: along which beam, to which wall, from which estimate
    of_gains.py     mistakes of S, K, x and P
    known.py        the table of them all
    guessing.py     the mistakes, alone or two together, that reproduce a student's numbers
    mutant.py       a filter with one of the mistakes

Every mistake is made in a step from the belief that the student's own filter had before it.
"""

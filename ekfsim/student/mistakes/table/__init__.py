"""The known mistakes, by what they change in a step.

    steps.py     the steps in which a mistake can be made
    moves.py     the mean of a motion, and the input that it is predicted with
    slopes.py    J_x and J_u
    noise.py     P_u, and what is made of P by a motion
    readings.py  ν, J_H and C_v
    beams.py     h: along which beam, to which wall, from which estimate
    gains.py     S, K, x and P
    repeated.py  updates that are made again, of which some of gains.py are
    beliefs.py   the belief that a step begins with, and whether it is revised at all
    numbers.py   noise of other numbers than the model's, which the student's own numbers tell

In each file the most common come first.
"""

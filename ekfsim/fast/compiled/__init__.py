"""By code that Numba compiles, the extra `fast`: imported only where that is asked for.

    block.py    a block of the classroom's runs, watched by ekf, huber or pdaf, from its draws to
                its tally
    beams.py    what the beams of many runs meet, and where walls stop the robots
    steps.py    how the true robots move, and how the EKF predicts and updates
    trusting.py how far huber and pdaf believe a reading
    carlson.py  an update by the square root of P, where a sensor is far sharper than the belief
    models.py, kalman.py, nees.py  a text each, of runs side by side, (3, 3, N)
    angles.py   wrapping, and the directions of many headings
    judging.py  NEES of many beliefs, singular ones too, and what is counted of a step

Numba keeps what it has compiled as long as the file of a function does not change, whatever that
function calls in other files: tolerances come as arguments.
"""

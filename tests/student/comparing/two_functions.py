"""A student's filter of two functions, called as it is; and the right one, to be got wrong."""

from dataclasses import replace

from ekfsim.localization import filter_of, first_belief
from ekfsim.records import Control
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer
from ekfsim.student.comparing.compare import compare


class Functions:
    """Calls two functions."""

    def __init__(self, predict, update):
        self.predict, self.update = predict, update

    def begin(self, x, P):
        pass

    def call(self, asked):
        given, x, P = asked.given, asked.x.copy(), asked.P.copy()
        if isinstance(given, Control):
            return Answer(*self.predict(x, P, given.u, given.motion))
        return Answer(*self.update(x, P, given.z, given.sensor))


def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T


def update(x, P, z, sensor):
    H = sensor.H(x)
    K = P @ H.T / (H @ P @ H.T + sensor.R(x))
    return x + K @ (z - sensor.h(x)), P - K @ H @ P


def compared(made, predict=predict, update=update, against="ekf", run=0):
    made = replace(made, run=run)
    reference = filter_of(replace(made, filter=against))
    caller = Functions(predict, update)
    return compare(simulate(made), first_belief(made), caller, reference, guard=made.guard)

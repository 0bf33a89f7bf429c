"""Students' files that the tests write."""

FUNCTIONS = """\
import numpy as np

def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)

def update(x, P, z, sensor):
    H = sensor.H(x)
    S = H @ P @ H.T + sensor.R(x)
    K = P @ H.T @ np.linalg.inv(S)
    return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(len(x)) - K @ H) @ P
"""
CLASS = """\
import numpy as np

class Mine:
    def __init__(self, x, P):
        self.x, self.P = x, P

    def predict(self, u, motion):
        F, G = motion.F(self.x, u), motion.G(self.x, u)
        self.x = motion.f(self.x, u)
        self.P = F @ self.P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)

    def update(self, z, sensor):
        H = sensor.H(self.x)
        S = H @ self.P @ H.T + sensor.R(self.x)
        K = self.P @ H.T @ np.linalg.inv(S)
        self.x = self.x + K @ sensor.residual(z, sensor.h(self.x))
        self.P = (np.eye(len(self.x)) - K @ H) @ self.P
"""

"""A class around the two functions of a student's file."""

CLASS = """
class Mine:
    def __init__(self, x, P):
        self.x, self.P = x, P

    def predict(self, u, motion):
        self.x, self.P = predict(self.x, self.P, u, motion)

    def update(self, z, sensor):
        self.x, self.P = update(self.x, self.P, z, sensor)
"""

"""What the textbook calls f and h, each with its Jacobian under it and its noise; a file per robot
or sensor.
"""

"""Document 004, lidar and inertial unit around one pylon."""

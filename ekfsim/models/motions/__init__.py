"""f, F, G, M and Q, a file a robot."""

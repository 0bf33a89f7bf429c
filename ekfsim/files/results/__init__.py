"""What a run leaves: trace, tables and trajectories, each whole or not at all."""

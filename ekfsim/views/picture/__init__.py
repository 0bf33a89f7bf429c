"""What is drawn of a run with matplotlib: artists that are made once and moved, axes, frames."""

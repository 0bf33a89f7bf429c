"""A file for each kind of plan: how it is recognised, and how it is read."""

"""What is told and drawn of many runs: studies and comparisons."""

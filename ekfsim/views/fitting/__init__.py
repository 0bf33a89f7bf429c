"""What is told and drawn of noises that were fitted to a log."""

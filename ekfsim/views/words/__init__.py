"""What is said of a run: the narrative, its numbers, its captions and its end."""

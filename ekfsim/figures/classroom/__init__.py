"""Document 002, the teaching assignment."""

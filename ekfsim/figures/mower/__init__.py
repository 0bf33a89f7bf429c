"""Document 000, the golf-course mower."""

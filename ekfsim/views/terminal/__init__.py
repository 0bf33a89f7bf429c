"""A run at the keyboard: keys in, text and pictures out, in a terminal or a window."""

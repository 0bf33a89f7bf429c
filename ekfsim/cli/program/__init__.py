"""How the program begins and ends, and what its commands share: options, kinds of values."""

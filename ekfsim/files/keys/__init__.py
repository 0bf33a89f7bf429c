"""The keys of every kind of file, with their bounds, units and defaults."""

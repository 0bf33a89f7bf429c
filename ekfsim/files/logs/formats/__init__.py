"""The recorded logs that are read, a file a format."""

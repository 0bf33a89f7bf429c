"""The keys of a recording: its format and files, columns and units, the topics of a bag."""

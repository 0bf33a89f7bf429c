"""YAML with the place of every value, and mistakes told in words."""

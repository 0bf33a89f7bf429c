"""Text ↔ objects: world and commands files. Nothing heavy is imported here; see `load`, `packaged`, `template`."""

"""World, commands and study files → scenes; all mistakes at once."""

"""The narrative: what is said at each step, of the classroom and of what is driven or recorded."""

"""What a hunt found, in words."""

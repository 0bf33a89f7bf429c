"""Document 003, the lawn mower with GNSS and wheel speeds."""

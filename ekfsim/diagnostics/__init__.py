"""Whether to believe the filter, and what should be known of a reading before it is used."""

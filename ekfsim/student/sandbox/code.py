"""Over there: the student's code itself, loaded once and called for one run after another."""

"""Legs: whole periods of many lines at once, cut to the clock that really drove them, and what each line tells."""

"""The search for the strongest lines: uses of limits in time, the criterion, and both as one smooth function."""

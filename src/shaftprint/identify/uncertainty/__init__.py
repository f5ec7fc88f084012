"""How far a number can be trusted: profile intervals, repeats, bands and the budget of every source."""

"""How the lowest cost is found: settings, starts, descent within bounds and beside the border of stability."""

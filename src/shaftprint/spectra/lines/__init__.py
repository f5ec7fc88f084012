"""Test lines: their windows, the fit of their sines, the noise beside them, what of ship or logger shows in them."""

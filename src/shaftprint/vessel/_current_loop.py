"""Instruments that show what they measure as a current of 4 to 20 mA."""

LIVE_ZERO_MA = 4.0
"""What such a loop shows at the lower end of its range [mA]."""
ALIVE_MA = (3.6, 21.0)
"""Beyond these a loop has failed [mA] (NAMUR recommendation NE 43)."""

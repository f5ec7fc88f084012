"""What shaft and engine do when the set point moves, and the limits of the ship as bounds of that."""

"""Steady stretches, the wander about them, and what is read from their means: calibration and working point."""

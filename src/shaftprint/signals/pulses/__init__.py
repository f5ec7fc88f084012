"""Voltage to speed: edges, numbered pulses, reflection strips, and the slope of the angle."""

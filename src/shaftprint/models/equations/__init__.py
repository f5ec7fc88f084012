"""Equations in time: formulas, their derivatives and values, the flow that a block asks, limits and engine parts."""

"""A simulated ship in ordinary service: what its crew does with the lever, and the logs of its days."""

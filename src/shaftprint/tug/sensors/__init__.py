"""The logger's view of the simulated ship: one stream of raw counts a sensor, with its faults.

Each takes the stretches of a voyage of ``shaftprint.tug.plant`` in order and gives the counts of its channel.
"""

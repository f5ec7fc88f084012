"""The propulsion line of the simulated ship: its constants, its state, its rates, and how it is stepped in time.

``shaftprint.tug.sensors`` measures it. Quantities and signs are those of ``shaftprint.tug``.
"""

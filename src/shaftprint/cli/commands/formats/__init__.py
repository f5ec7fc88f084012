"""The formats of ``shaftprint export``: a table, and a file for each that has options of its own."""

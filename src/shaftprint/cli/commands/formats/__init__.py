"""The formats of ``shaftprint export``, one file each."""

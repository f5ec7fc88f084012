"""Dewesoft files, unpacked by Dewesoft's own library in a separate process."""

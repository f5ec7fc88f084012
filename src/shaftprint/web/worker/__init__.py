"""The process that does the jobs of a server; see its program."""

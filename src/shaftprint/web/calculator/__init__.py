"""A process beside the server that reads what users have written: fingerprints and recordings, with limits.

It is asked by a line of JSON on its standard input and answers by one on its standard output. The server itself loads
nothing that calculates, and opens no file of a user.
"""

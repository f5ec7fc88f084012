"""Files by real writers, read and held against what the writer was given: ``python -m benchmarks.real_writers DIR``.

Each file of this folder writes one family of formats with a library of others, never with our own writers: every
extreme of the options once, the rest drawn. What was written is kept as the truth: values, units, times, validity,
date.
"""

"""Benchmarks: shaftprint beside its peers in one run, see ``docs/benchmarks.md``. Run ``python -m benchmarks``."""

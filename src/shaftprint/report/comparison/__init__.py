"""What differs between fingerprints: numbers, errors that the tests share, and their tables."""

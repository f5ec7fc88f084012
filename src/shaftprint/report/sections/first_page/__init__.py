"""The first page of the report of one fingerprint, for the superintendent."""

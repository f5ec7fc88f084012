"""The thesis' way beside the identification: its models, and where its numbers come from."""

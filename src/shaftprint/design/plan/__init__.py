"""The noun ``Plan`` with its parts: legs, how time is divided, and the campaign that it becomes."""

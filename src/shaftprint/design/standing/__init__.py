"""The noun ``Standing``: a planned test that was sailed in part, and what is still missing."""

"""Who asks, what he may see and do, and what is written down of it."""

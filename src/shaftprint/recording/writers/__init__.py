"""Recordings for other tools: one file a format; values in the channel's unit instead of counts."""

"""The kinds of channels: how each is read, conditioned and made a signal."""

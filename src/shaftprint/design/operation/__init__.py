"""Where a test leaves the limits of ship and engine: of a campaign as it is expected, of a recording as it was sailed.

Both give an ``Operation``, and ``limit_uses`` holds it against ``Limits``: the one place where that is done.
"""

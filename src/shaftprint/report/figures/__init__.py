"""What each figure of a report shows, one a file; every ``*_chart`` function returns a ``Chart``, whoever draws it."""

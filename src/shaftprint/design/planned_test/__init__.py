"""The noun ``PlannedTest``: a plan ready to be sailed, with its rehearsal, its verdict and what would help."""

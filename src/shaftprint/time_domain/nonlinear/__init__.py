"""Lines with limits: from small signals and large in one likelihood to the levels of the limits."""

"""From inputs to a plan: what is laid down before the search, the lines that it finds, and their amplitudes."""

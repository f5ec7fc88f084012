"""What a fit minimises: lines, records and priors as terms of one likelihood, with their weights."""

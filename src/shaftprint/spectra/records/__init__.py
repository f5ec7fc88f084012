"""Records without test lines, arbitrary or periodic: from arrays to responses with covariance."""

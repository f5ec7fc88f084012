"""The verb and what it found: values, covariance, test of fit, other optima, the cost along a parameter."""

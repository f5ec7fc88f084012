"""What is done to a channel before it is a signal: outliers, repairs, decimation, and the thesis' own way."""

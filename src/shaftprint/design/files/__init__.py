"""Files of a planned test: the plan itself, its campaign, and its set point for generators and MATLAB."""

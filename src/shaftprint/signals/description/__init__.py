"""A recorded set point as a campaign: sines, sweeps, multisines, binary sequences, staircases and ramps."""

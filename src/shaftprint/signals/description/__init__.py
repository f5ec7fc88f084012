"""A recorded set point as a campaign: sines, sweeps, multisines, binary sequences, staircases and ramps."""

from shaftprint.signals.description._describe import Description, described

__all__ = ["Description", "described"]

"""What the set point of the speed shows in each leg."""

from shaftprint.spectra._leg_spectra import SPEED, estimate_inputs_of_legs


def estimate_legs(signals, campaign):
    return {name: by_input[SPEED] for name, by_input in estimate_inputs_of_legs(signals, campaign).items()}

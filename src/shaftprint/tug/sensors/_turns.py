"""Turns of a sensor's shaft for one of the propeller shaft."""

from shaftprint.vessel import SpeedSensor, Vessel


def turns_of(sensor: SpeedSensor, vessel: Vessel) -> float:
    """Return the turns of the shaft of a sensor for one of the propeller shaft.

    An engine turns as ever while a gearbox that reverses turns the propeller shaft astern: negative then.
    """
    turns = vessel.gearbox.over_propeller(sensor.shaft)
    return vessel.working_point.turning * turns if sensor.shaft == "engine" else turns

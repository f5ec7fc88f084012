"""What a sensor on one of the shafts sees of the line: its turns for one of the propeller shaft, speed and angle."""

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel


def turns_of(sensor: SpeedSensor, vessel: Vessel) -> float:
    """Return the turns of the shaft of a sensor for one of the propeller shaft.

    An engine turns as ever while a gearbox that reverses turns the propeller shaft astern: negative then.
    """
    turns = vessel.gearbox.over_propeller(sensor.shaft)
    return vessel.working_point.turning * turns if sensor.shaft == "engine" else turns


def motion_of(sensor: SpeedSensor, stretch: Stretch) -> tuple[FloatArray, FloatArray]:
    """Return speed [rev/s] and angle [rev] at a sensor, at the propeller shaft, each of shape (steps,).

    A sensor on the engine's shaft sits ahead of a coupling that twists.
    """
    if sensor.shaft == "engine":
        return stretch.engine_speed_rev_s, stretch.engine_angle_rev
    return stretch.shaft_speed_rev_s, stretch.shaft_angle_rev

"""A coupling that twists between two pick-ups, from made-up ratios of their speeds."""

import numpy as np
import pytest

from shaftprint.spectra._speed_ratios import SpeedRatio
from shaftprint.survey._twist import twist_reasons
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
LINES_HZ = np.array([0.02, 0.06, 0.15, 0.3, 0.5, 0.8, 1.25, 2.0, 3.3])
STD = np.array([2e-5, 2e-5, 4e-5, 6e-5, 1e-4, 2e-4, 4e-4, 1.5e-3, 1.3e-2])


def ratio(alone_hz=np.inf, rng=None, name="n_e4", lines=slice(None)):
    """Return what the shaft shows over the engine where all behind a coupling swings at ``alone_hz``."""
    size = 1.0 / (1.0 - (LINES_HZ / alone_hz) ** 2)
    noise = np.zeros(size.size) if rng is None else STD * rng.standard_normal(size.size)
    return SpeedRatio(
        name=name, frequency_hz=LINES_HZ[lines], size=(size * np.exp(noise))[lines], std=STD[lines]
    )  # fmt: skip


def test_a_twist_is_named_with_its_frequency_and_size():
    (reason,) = twist_reasons((ratio(9.0, np.random.default_rng(3)),), VESSEL)
    assert (reason.kind, reason.where) == ("elastic coupling", "PTM_e")
    assert "between PTM_e on the engine and PTM_4 on the propeller's shaft" in reason.sentence
    grown, deviation = reason.sentence.split(" times at 3.30 Hz")[0].split("frequency, to ")[1].split(" +/- ")
    assert abs(float(grown) - 1.0 / (1.0 - (3.3 / 9.0) ** 2)) < 3.0 * float(deviation) < 0.06
    swings, deviation = reason.sentence.split(" Hz against")[0].split("swings at ")[1].split(" +/- ")
    assert abs(float(swings) - 9.0) < 3.0 * float(deviation) < 0.5


def test_rigid_lines_of_noise_are_silent():
    rng = np.random.default_rng(7)
    told = sum(bool(twist_reasons((ratio(rng=rng),), VESSEL)) for _ in range(2000))
    # one in ten thousand each
    assert told <= 2


def test_scatter_beyond_the_noise_is_no_twist():
    rng = np.random.default_rng(7)
    told = 0
    for _ in range(300):
        one = ratio(rng=rng)
        told += bool(
            twist_reasons((SpeedRatio(name="n_e4", frequency_hz=LINES_HZ, size=one.size**8, std=one.std),), VESSEL)
        )
    assert told <= 1


def test_the_engine_ahead_of_the_shaft_is_no_coupling():
    size = 1.0 - (LINES_HZ / 9.0) ** 2
    assert twist_reasons((SpeedRatio(name="n_e4", frequency_hz=LINES_HZ, size=size, std=STD),), VESSEL) == ()


@pytest.mark.parametrize("lines", [slice(0, 2), slice(0, 0)])
def test_few_lines_say_nothing(lines):
    assert twist_reasons((ratio(9.0, lines=lines),), VESSEL) == ()


def test_legs_are_one_comparison():
    """Three lines that scatter by their noise say nothing alone; those of two legs together do."""
    rng = np.random.default_rng(2)
    legs = tuple(ratio(15.0, rng, lines=lines) for lines in (slice(3, 9, 2), slice(2, 9, 2)))
    assert all(twist_reasons((leg,), VESSEL) == () for leg in legs)
    (reason,) = twist_reasons(legs, VESSEL)
    swings, deviation = reason.sentence.split(" Hz against")[0].split("swings at ")[1].split(" +/- ")
    assert abs(float(swings) - 15.0) < 3.0 * float(deviation) < 2.0


def test_rigid_legs_of_noise_are_silent():
    rng = np.random.default_rng(8)
    told = sum(bool(twist_reasons((ratio(rng=rng), ratio(rng=rng)), VESSEL)) for _ in range(2000))
    assert told <= 2


def test_the_sensor_that_shows_more_is_taken():
    coarse = ratio(9.0, name="n_e1", lines=slice(0, 6))
    (reason,) = twist_reasons((coarse, ratio(9.0)), VESSEL)
    assert "PTM_4" in reason.sentence


def test_a_speed_of_the_shaft_is_not_doubted():
    speeds = tuple(reversed(VESSEL.sensors.speed))
    other = VESSEL.model_copy(update={"sensors": VESSEL.sensors.model_copy(update={"speed": speeds})})
    assert twist_reasons((ratio(9.0, name="n_e"),), other) == ()
    assert twist_reasons((ratio(9.0, name="n_e1"),), other) == ()

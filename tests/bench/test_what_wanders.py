"""Numbers that move within a record: noise must not take up what they do and leave other numbers trusted."""

from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from scipy.signal import lfilter
from tests.bench.test_search_drive import ROTOR

from shaftprint.bench import equipped
from shaftprint.bench._record_reasons import REQUIREMENTS
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.drive import load_drive
from shaftprint.identify import Settings, assess
from shaftprint.time_domain import identify_in_time, record_from_arrays

pytestmark = pytest.mark.slow

TRUTH = {"a": 800.0, "B": 2e-3, "T_C": 0.1}
INVERSE_INERTIA, VISCOUS, DRY = TRUTH.values()
RATE_HZ, FINE, SAMPLES = 50.0, 100, 600


def reversals(rng, wanders, by_place=0.0):
    """Return torque and speed of a rotor that goes both ways, its dry friction within a share of its mean.

    ``by_place``: a torque that comes again each 400 rad, as of teeth or of a screw [N m].
    """
    torque = np.repeat(rng.uniform(-0.6, 0.6, SAMPLES // 20), 20)
    torque[:20] = 0.0
    walk = np.cumsum(rng.standard_normal(SAMPLES))
    friction = DRY * (1.0 + wanders * (walk - walk.mean()) / np.abs(walk - walk.mean()).max())
    speed, place, speeds, step = 0.0, 0.0, [], 1.0 / (RATE_HZ * FINE)
    for push, dry in zip(torque, friction, strict=True):
        speeds.append(speed)
        for _ in range(FINE):
            pushed = push - VISCOUS * speed - by_place * np.sin(2.0 * np.pi * place / 400.0)
            free = speed + step * INVERSE_INERTIA * pushed
            speed = np.sign(free) * max(abs(free) - step * INVERSE_INERTIA * dry, 0.0)
            place += step * speed
    return torque, np.array(speeds)


@lru_cache(maxsize=1)
def rotor():
    with TemporaryDirectory() as folder:
        path = Path(folder) / "rotor.toml"
        path.write_text(ROTOR, encoding="utf-8")
        return equipped(load_drive(path))


def judged(seed, *, wanders=0.0, pole=0.0, by_place=0.0):
    """Return the fit to one record from the truth on, whose noise is 2 rad/s, and its verdict."""
    rng = np.random.default_rng(seed)
    torque, speed = reversals(rng, wanders, by_place)
    noise = lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], rng.standard_normal(SAMPLES))
    record = record_from_arrays("both", {"T": torque}, {"omega": speed + 2.0 * noise}, rate_hz=RATE_HZ, hold=True)
    fit = identify_in_time(
        [(rotor().structure, record)],
        rng=rng,
        settings=Settings(starts=1),
        time=drive_time_settings(rotor(), [record]),
        start=TRUTH,
    )
    return fit, assess(fit, requirements=REQUIREMENTS)


@pytest.mark.parametrize("seed", [3, 4])
def test_dry_friction_that_wanders_is_named_and_not_trusted(seed):
    _, verdict = judged(seed, wanders=0.5)
    assert not verdict.trustworthy
    assert "T_C" in verdict.reason
    assert "does not stay the same from its beginning to its end" in verdict.reason


@pytest.mark.parametrize("seed", [3, 4, 5])
def test_a_torque_that_hangs_on_the_place_is_no_noise(seed):
    """A third of the dry friction."""
    _, verdict = judged(seed, by_place=0.03)
    assert not verdict.trustworthy
    assert verdict.trusted == ()


@pytest.mark.parametrize("pole", [0.0, 0.9])
def test_dry_friction_that_stays_is_trusted(pole):
    fit, verdict = judged(3, wanders=0.0, pole=pole)
    assert verdict.trustworthy, verdict.sentences
    assert all(abs(one.value - TRUTH[one.name]) < 4.0 * one.std for one in fit.parameters)

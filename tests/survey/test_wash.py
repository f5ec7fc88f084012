"""The wash of one propeller on the other, from signals that are made by hand: its share, and when none is seen."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.signals import LegState, WorkingPoint
from shaftprint.survey._wash import Wash, wash_on, wash_sentences

RATE_HZ, PERIOD_S, PERIODS = 200.0, 20.0, 10
TAU_DN, K_Q, POINT_RPM = 0.3, 1.98, 1200.0
HARMONICS = (1, 3, 7, 15)
POINT = WorkingPoint(
    engine_speed_rev_s=POINT_RPM / 60.0,
    shaft_torque_nm=1700.0,
    engine_speed_std_rev_s=0.0,
    shaft_torque_std_nm=0.0,
    set_point_v=-5.0,
    load_std=0.0,
)


@dataclass
class Channel:
    """A channel without a sensor's faults."""

    values: np.ndarray

    def gain(self, frequency_hz: float) -> complex:
        return 1.0 + 0.0j


def sum_of(amplitudes: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    turns = 2.0 * np.pi * np.outer(np.array(HARMONICS) / PERIOD_S, time_s)
    return (amplitudes[:, None] * np.exp(1j * turns)).sum(axis=0).real


def survey(speed: np.ndarray, torque: np.ndarray, wash: tuple[float, float]) -> Any:
    """A survey as far as the wash asks for it."""
    line = structure("GAUGE-CLOSED")
    values = np.array([{"tau_dn": TAU_DN, "k_q": K_Q}.get(p.name, p.value) for p in line.parameters])
    state = LegState(name="M1", start_s=5.0, period_s=PERIOD_S, periods=PERIODS, working_point=POINT)
    return SimpleNamespace(
        vessel=SimpleNamespace(wash=wash, working_point=SimpleNamespace(engine_speed_rpm=POINT_RPM)),
        campaign=SimpleNamespace(legs=(SimpleNamespace(name="M1", lines=dict.fromkeys(HARMONICS, 0.1)),)),
        identification=SimpleNamespace(structure=line, structure_values=lambda: values),
        signals=SimpleNamespace(
            channels={"M_s": Channel(1700.0 * (1.0 + torque))},
            engine_speed=Channel(20.0 * (1.0 + speed)),
            working_point=POINT,
            legs=(state,),
            start_s=0.0,
            rate_hz=RATE_HZ,
        ),
    )


def both(share: float, *, noise: float, seed: int = 1, wash: tuple[float, float] = (0.0, 0.02)) -> Any:
    """Own speed swings by something, and the torque by inertia, propeller and the wash of the other, 0.3 s late."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(round(210.0 * RATE_HZ)) / RATE_HZ
    s = 2j * np.pi * np.array(HARMONICS) / PERIOD_S
    own, other = (size * np.exp(2j * np.pi * rng.uniform(size=len(HARMONICS))) for size in (0.002, 0.05))
    late = np.exp(-0.3 * s) / (0.5 * s + 1.0)
    torque = (TAU_DN * s + K_Q) * own - share * late * other
    shown = sum_of(torque, time_s) + noise * rng.standard_normal(time_s.size)
    side = survey(sum_of(own, time_s), shown, wash)
    return wash_on(side, survey(sum_of(other, time_s), np.zeros(time_s.size), wash))


def test_share_is_found_beside_inertia_and_propeller() -> None:
    wash = both(0.015, noise=2e-4)
    assert wash.share == pytest.approx(0.015, abs=5e-4)
    assert wash.std < 1e-3
    assert wash.is_seen
    assert wash.lines == len(HARMONICS)


def test_stated_deviation_is_that_of_repeats() -> None:
    found = [both(0.01, noise=0.02, seed=seed) for seed in range(40)]
    off = np.array([(one.share - 0.01) / one.std for one in found])
    # of 40 repeats the root mean square is known to 11 %; the table of delays makes it wide, never narrow
    assert 0.6 < np.sqrt(np.mean(off**2)) < 1.3


def test_without_a_word_from_the_test_the_vessel_file_stands() -> None:
    wash = both(0.0, noise=10.0, wash=(0.03, 0.01))
    assert (wash.share, wash.std) == (pytest.approx(0.03, abs=1e-3), pytest.approx(0.01, rel=0.02))


def test_structure_without_a_propeller_torque_tells_no_wash() -> None:
    side = survey(np.zeros(42_000), np.zeros(42_000), (0.0, 0.02))
    side.identification.structure = structure("GOVERNOR")
    side.identification.structure_values = lambda: np.array([p.value for p in structure("GOVERNOR").parameters])
    assert wash_on(side, side) is None


def test_words_say_when_none_is_seen() -> None:
    wash = Wash(share=0.004, std=0.003, prior=0.0, prior_std=0.02, lines=57)
    (said,) = wash_sentences({"port": wash})
    assert "0.40 +/- 0.30 % of the torque of port" in said
    assert said.endswith("none is seen.")

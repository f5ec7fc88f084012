from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.tug import Noise, Tug
from shaftprint.vessel import Vessel, load_vessel

Ask = Callable[..., Campaign]


@pytest.fixture(scope="session")
def vessel() -> Vessel:
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def vessel_with_bus() -> Vessel:
    return load_vessel("stan-tug-1205-ecu")


@pytest.fixture(scope="session")
def quiet() -> Noise:
    return Noise().without(process=True, measurement=True, faults=True)


@pytest.fixture(scope="session")
def quiet_tug(quiet: Noise) -> Tug:
    return Tug(noise=quiet)


@pytest.fixture(scope="session")
def ask() -> Ask:
    def campaign(duration_s: float = 20.0, **excitations: Any) -> Campaign:
        given = {"name": "short", "duration_s": duration_s, "offset_v": -5.0} | excitations
        if len(given) == 3:
            # a campaign needs an excitation: a staircase that stays where it is
            given["staircases"] = [{"name": "St", "levels_v": [-5.0], "dwell_s": 1.0, "start_s": 0.0}]
        return Campaign.model_validate(given)

    return campaign


@pytest.fixture(scope="session")
def sine() -> Callable[[float, float], dict[str, Any]]:
    def excitation(frequency_hz: float, amplitude_v: float) -> dict[str, Any]:
        settled = 10.0
        return {
            "name": "S",
            "frequency_hz": frequency_hz,
            "amplitude_v": amplitude_v,
            "start_s": 0.0,
            "settled_s": settled,
            "stop_s": settled + np.ceil(10.0 * frequency_hz) / frequency_hz + 0.01,
        }

    return excitation

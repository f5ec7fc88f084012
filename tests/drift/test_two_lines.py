"""Port and starboard in one recording: what cancels in their difference, and what is of each line alone."""

from typing import Any

import numpy as np
import pytest
from tests.known_fits import TRUTH, fitted, taken

from shaftprint.drift import differ, shared_errors
from shaftprint.drift._pair import pair_of
from shaftprint.drift._shared_errors import are_two_lines
from shaftprint.fingerprint import Fingerprint, SourceFile, vessel_fields
from shaftprint.identify import Prior, Settings
from shaftprint.report import differences
from shaftprint.vessel import load_vessel

# The upstream inertia is known to 2 % by its drawings, beside the scale of the gauge, another 2 %.
STD = 0.0285
HALF = STD / np.sqrt(2.0)
PRIORS = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, STD, sources={"TVC": HALF, "gauge scale": -HALF})}
PORT, STARBOARD = "stan-tug-1205", "stan-tug-1205-starboard"


def side(vessel: str, *, recording: str = "a", **changes: float) -> Fingerprint:
    values = TRUTH | {name: factor * TRUTH[name] or factor for name, factor in changes.items()}
    plain = taken(fitted("GAUGE-CLOSED", values, share=0.002, settings=Settings(starts=20, priors=PRIORS)))
    return plain.model_copy(
        update={
            "vessel_fields": vessel_fields(load_vessel(vessel)),
            "sources": (
                SourceFile(role="recording", name="both.nc", sha256=64 * recording),
                SourceFile(role="vessel", name=f"{vessel}.toml", sha256=64 * ("b" if vessel == PORT else "c")),
            ),
        }
    )


@pytest.fixture(scope="module")
def port() -> Fingerprint:
    return side(PORT)


@pytest.fixture(scope="module")
def starboard() -> Fingerprint:
    return side(STARBOARD)


def deviation(first: Fingerprint, other: Fingerprint, name: str) -> float:
    pair = pair_of(first, other, load_repeatability=0.005)
    assert pair is not None
    place = pair.names.index(name)
    return float(np.sqrt(pair.covariance[place, place]))


@pytest.mark.slow
def test_two_gauges_in_one_recording_are_two_lines(port: Fingerprint, starboard: Fingerprint) -> None:
    assert are_two_lines(port, starboard)
    assert not are_two_lines(port, port)
    # on another day a renamed channel does not make another gauge, but a ship that says its lines has two
    later = side(STARBOARD, recording="d")
    assert not are_two_lines(port, later)
    said = [
        one.model_copy(update={"vessel_fields": {**one.vessel_fields, "ship.line": line}})
        for one, line in ((port, "port"), (later, "starboard"))
    ]
    assert are_two_lines(*said)
    assert shared_errors(*said).of_each_piece == shared_errors(port, starboard).of_each_piece > 0.0


def test_drawings_and_assumptions_cancel_and_sensors_do_not(port: Fingerprint, starboard: Fingerprint) -> None:
    shared = shared_errors(port, starboard)
    assert {"TVC", "prior of g"} <= set(shared.common)
    assert shared.apart == ("gauge scale",)


def test_each_gauge_has_a_scale_error_of_its_own(port: Fingerprint, starboard: Fingerprint) -> None:
    """K_Q is known to 2 % by each gauge: their difference to 2.8 %, beside 0.5 % of load at each propeller."""
    noise = port.joint.covariance_of(("K_Q",))[0, 0] / port.quantity("K_Q").value ** 2  # type: ignore[union-attr]
    by_hand = np.sqrt(2.0 * (0.02**2 + 0.005**2 + noise))
    assert deviation(port, starboard, "K_Q") == pytest.approx(by_hand, rel=1e-3)


def test_an_inertia_by_one_drawing_differs_by_a_quarter_of_what_that_leaves_open(
    port: Fingerprint, starboard: Fingerprint
) -> None:
    """sqrt(2 / 16) of what the drawings leave open of each, less what the drawing pulls the estimate back to itself."""
    of_drawing = port.joint.loadings_of(("I_up",))["TVC"][0] / port.quantity("I_up").value  # type: ignore[union-attr]
    pieces = deviation(port, starboard, "I_up") ** 2
    piece = deviation(port, port.model_copy(), "I_up") ** 2
    # the gauges move it as far as the test, and not the drawing, tells it
    of_gauge = port.joint.loadings_of(("I_up",))["gauge scale"][0] / port.quantity("I_up").value  # type: ignore[union-attr]
    of_assumption = port.joint.loadings_of(("I_up",))["prior of g"][0] / port.quantity("I_up").value  # type: ignore[union-attr]
    by_hand = ((HALF / 1.016 - of_drawing) ** 2 + of_assumption**2) / 8.0 + 2.0 * of_gauge**2
    assert pieces - piece == pytest.approx(by_hand, rel=0.02)


@pytest.mark.parametrize("changes", [{"tau_up": 1.0 + 0.25 * HALF / 1.016}, {"g": 0.025}])
def test_a_line_that_is_one_piece_off_its_drawing_is_as_likely_as_that(
    port: Fingerprint, changes: dict[str, float]
) -> None:
    """One standard deviation of one piece, without noise; gains that make up for it are no change of the governor."""
    pair = pair_of(port, side(STARBOARD, **changes), load_repeatability=0.005)
    assert pair is not None
    assert pair.difference @ np.linalg.solve(pair.covariance, pair.difference) < 1.0
    gain = pair.directions[:, [cause.name for cause in pair.causes].index("proportional gain of the governor")]
    score = gain @ np.linalg.solve(pair.covariance, pair.difference)
    assert abs(score) < np.sqrt(gain @ np.linalg.solve(pair.covariance, gain))


def test_numbers_side_by_side_have_the_same_deviations(port: Fingerprint, starboard: Fingerprint) -> None:
    by_name = {one.first.name: one for one in differences(port, starboard)}
    low, high = by_name["K_Q"].interval_95 or (0.0, 0.0)
    half = 0.5 * (high - low) / 1.96 / port.quantity("K_Q").value
    assert half == pytest.approx(deviation(port, starboard, "K_Q"), rel=0.01)


@pytest.mark.parametrize(
    ("change", "cause"),
    [({"K_p": 0.95}, "proportional gain of the governor"), ({"t_d": 1.1}, "delay of governor and fuel")],
)
def test_what_is_other_to_starboard_is_named(port: Fingerprint, change: dict[str, Any], cause: str) -> None:
    (found,) = differ(port, side(STARBOARD, **change)).changes
    assert found.best.cause.name == cause

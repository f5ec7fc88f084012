"""The valley of delay, gains and actuator made straight: estimates by SciPy, which share no code with it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from tests.drift.test_differ import PRIORS
from tests.drift.test_watch import I_ACTION, P_ACTION, looked_at, made
from tests.known_fits import TRUTH, fitted, taken

from shaftprint.catalogue import structure
from shaftprint.fingerprint._joint_numbers import JointNumbers
from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum
from shaftprint.identify import Settings
from shaftprint.models import at_working_point

MODEL = structure("GAUGE-CLOSED")
# The speed of the parameters, and another leg's over it; the torque of a propeller goes with its square.
SPEED_RPM, SLOW = 1183.8, 0.7
AT = {SPEED_RPM: MODEL, SLOW * SPEED_RPM: at_working_point(MODEL, speed_share=SLOW)}
FREQUENCY_HZ = (0.02, 0.035, 0.06, 0.15, 0.3, 0.5, 0.8, 1.25, 2.0, 3.3)
NUMBERS = ("K_p", "K_i", "t_d", "omega_n", "zeta", "tau_dn", "t_sp")
TIMES = ("t_d", "t_sp")
NAMES = (P_ACTION, I_ACTION, "t_d", "omega_n", "zeta", "I_dn", "t_sp")
SHARE, TESTS, STEP_AT, WEAKER = 0.012, 12, 6, 0.02
"""Relative noise of each response; tests, the first one with a weaker injection, and by how much it is weaker."""


def logarithms(values, speeds):
    """Return the logarithms of both responses at the lines of each speed as real numbers."""
    omega = 2.0 * np.pi * np.array(FREQUENCY_HZ)
    response = np.log([AT[speed].response(MODEL.vector(values), 1j * omega) for speed in speeds])
    return np.concatenate([response.real.ravel(), response.imag.ravel()])


def moved(values, apart):
    """Return parameters after changes: of logarithms, and of times."""
    step = dict(zip(NUMBERS, apart, strict=True))
    return values | {
        name: values[name] + change if name in TIMES else values[name] * np.exp(change) for name, change in step.items()
    }


def slopes(values, speeds):
    """Return the derivatives of the logarithms, by central differences."""
    steps = 1e-6 * np.eye(len(NUMBERS))
    apart = [logarithms(moved(values, h), speeds) - logarithms(moved(values, -h), speeds) for h in steps]
    return np.array(apart).T / 2e-6


def estimate(true, noise, speeds):
    """Return the estimate of a line from noisy responses, as changes from the reference, and its covariance."""
    data = logarithms(true, speeds) + noise

    def residuals(x):
        return (logarithms(moved(TRUTH, x), speeds) - data) / SHARE

    found = least_squares(residuals, np.zeros(len(NUMBERS)), x_scale="jac")
    at = slopes(moved(TRUTH, found.x), speeds) / SHARE
    return found.x, np.linalg.inv(at.T @ at)


def fingerprint(base, place, apart, covariance, speeds):
    """Return the fingerprint of an estimate, which states its own covariance."""
    shift = dict(zip(NAMES, apart, strict=True))
    factors = {name: np.exp(change) for name, change in shift.items() if name not in TIMES}
    one = made(place, base, **factors)
    parameters = tuple(
        replace(number, value=TRUTH[number.name] + shift[number.name]) if number.name in TIMES else number
        for number in one.parameters
    )
    names = ("I_up", *NAMES)
    size = np.array([1.0 if name in TIMES else one.quantity(name).value for name in names])
    own = np.zeros((len(names), len(names)))
    own[0, 0] = 1e-6
    own[1:, 1:] = covariance
    own *= np.outer(size, size)
    noise = tuple(
        NoiseSpectrum(
            engine_speed_rpm=speed,
            set_point_per_v=0.21,
            outputs=("n", "M_s"),
            frequency_hz=FREQUENCY_HZ,
            density_real=((((1e-6, 0.0), (0.0, 1e-6))),) * len(FREQUENCY_HZ),
            density_imaginary=((((0.0, 0.0), (0.0, 0.0))),) * len(FREQUENCY_HZ),
        )
        for speed in speeds
    )
    legs = tuple(
        LegRecord(
            name=f"M{number}",
            engine_speed_rpm=base.conditions.engine_speed.value * speed / SPEED_RPM,
            shaft_torque_nm=base.conditions.shaft_torque.value * (speed / SPEED_RPM) ** 2,
            set_point_v=-5.0,
            load=1.0,
            periods=3,
            period_s=50.0,
        )
        for number, speed in enumerate(speeds)
    )
    joint = JointNumbers(names=names, own_covariance=tuple(map(tuple, own.tolist())), loadings={})
    return one.model_copy(update={"parameters": parameters, "joint": joint, "noise": noise, "legs": legs})


@pytest.fixture(scope="module", params=[1, 2], ids=["one speed", "two speeds"])
def speeds(request):
    return tuple(AT)[: request.param]


@pytest.fixture(scope="module")
def histories(speeds):
    """Tests with the frequencies of their lines, and the same without: there the valley stays as it is."""
    base = taken(fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=10, priors=PRIORS)))
    rng = np.random.default_rng(5)
    tests = []
    for place in range(TESTS):
        weaker = 1.0 - WEAKER * (place >= STEP_AT)
        true = TRUTH | {name: weaker * TRUTH[name] for name in ("K_p", "K_i")}
        noise = SHARE * rng.standard_normal(4 * len(FREQUENCY_HZ) * len(speeds))
        tests.append(fingerprint(base, place, *estimate(true, noise, speeds), speeds))
    return tests, [one.model_copy(update={"noise": ()}) for one in tests]


def of_injection(tests):
    """Return the clearest change by injection, whether it is seen or within chance."""
    finding = looked_at(tests)[1]
    drift = finding.drifts[0] if finding.drifts else finding.nearest
    return next(one for one in drift.courses if one.cause.name == "injection or turbocharger")


@pytest.mark.slow
def test_a_step_is_known_as_well_as_the_responses_tell_it(histories, speeds):
    """Cramer and Rao's bound of one test, the root of two of it for the difference of two, over the root of six."""
    straight, as_it_is = (of_injection(tests) for tests in histories)
    at = slopes(TRUTH, speeds) / SHARE
    information = at.T @ at
    along = np.isin(NUMBERS, ("K_p", "K_i")).astype(float)
    bound = np.sqrt(2.0 / (along @ information @ along) / STEP_AT)
    assert (straight.shape, straight.since) == ("step", STEP_AT)
    assert straight.std == pytest.approx(bound, rel=0.1)
    assert straight.size == pytest.approx(-WEAKER, abs=3.0 * bound)
    # a mean of covariances that turn is wider
    assert as_it_is.std > 1.15 * straight.std

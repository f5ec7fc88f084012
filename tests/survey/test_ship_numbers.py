"""Wake, thrust deduction and resistance from responses without noise, and what the vessel file leaves open of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import shipped_structure
from shaftprint.identify import Prior, Settings, identify, priors_from_vessel
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey import of_vessel
from shaftprint.survey._ship_numbers import ship_numbers
from shaftprint.tug import like_stan_tug_1205, normalised_truth
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205-underway")
TRUTH = normalised_truth(like_stan_tug_1205(VESSEL, offset_v=-6.66), VESSEL)
SPEED_REV_S, TORQUE_NM = 1600.0 / 60.0, 2570.0
FREQUENCY_HZ = np.array([0.01, 0.02, 0.035, 0.06, 0.1, 0.16, 0.25, 0.4, 0.63, 1.0, 1.6])
STD = 1e-4


def fit_of(vessel, std):
    """The fit of FREE-LOG to its own response, and the signals that it would be made from."""
    structure = of_vessel(shipped_structure("FREE-LOG"), vessel)
    names = {"tau_up", "tau_dn", "K_p", "K_i", "t_d", "omega_n", "zeta", "t_sp", "a", "b", "e", "tau_u"}
    values = structure.vector({name: TRUTH[name] for name in names})
    measured = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=np.asarray(structure.response(values, 2j * np.pi * FREQUENCY_HZ)).reshape(3, 1, -1),
        covariance=np.broadcast_to(std**2 * np.eye(6), (FREQUENCY_HZ.size, 6, 6)),
        inputs=("n_set",),
        outputs=("n", "M_s", "v_s"),
    )
    point = SimpleNamespace(engine_speed_rev_s=SPEED_REV_S, shaft_torque_nm=TORQUE_NM)
    priors = priors_from_vessel(structure, vessel, point)
    fit = identify(structure, measured, rng=np.random.default_rng(1), settings=Settings(starts=6, priors=priors))
    return fit, SimpleNamespace(working_point=point, channels={"v_s": SimpleNamespace(reference=TRUTH["v_0"])})


@pytest.fixture(scope="module")
def fitted():
    return fit_of(VESSEL, STD)


def found(fitted, vessel):
    fit, signals = fitted
    return {one.name: one for one in ship_numbers(fit, signals, vessel, rng=np.random.default_rng(1))}


def silent(**of_log):
    """The vessel file with nothing left open but what is given."""
    propeller = VESSEL.propeller.model_copy(update={"pitch_std_fraction": 0.0})
    log = VESSEL.sensors.ship_speed.model_copy(update={"scale_std_fraction": 0.0} | of_log)
    sensors = VESSEL.sensors.model_copy(update={"ship_speed": log})
    return VESSEL.model_copy(update={"propeller": propeller, "sensors": sensors})


@pytest.mark.slow
def test_the_truth_comes_back_without_noise(fitted):
    numbers = found(fitted, VESSEL)
    # the polynomials of the simulated ship are those of the series to four digits
    for name, truth in (("w", TRUTH["w"]), ("t", TRUTH["t"]), ("R", TRUTH["R"]), ("R exponent", TRUTH["e"])):
        assert numbers[name].value == pytest.approx(truth, rel=0.02), name
    assert numbers["w"].expected == 0.20
    assert numbers["R"].expected == pytest.approx(43000.0 * (TRUTH["v_0"] / 5.093) ** 4)


@pytest.mark.slow
def test_a_log_that_may_show_two_per_cent_too_much(fitted):
    """A wake of 0.20 seen through a log 2 % off is 0.216: the propeller sees 0.784 of the speed that is shown."""
    without, with_it = found(fitted, silent()), found(fitted, silent(scale_std_fraction=0.02))
    added = np.sqrt(with_it["w"].std ** 2 - without["w"].std ** 2)
    assert added == pytest.approx(0.02 * (1.0 - TRUTH["w"]), rel=0.05)


def test_zero_of_the_gauge_is_in_the_deviations():
    """1 % of the mean torque moves the wake by 0.016 where the responses are not so good that they show it."""
    std = {}
    for zero_nm in (1e-3, 25.0):
        known = silent()
        gauge = known.sensors.shaft_torque.model_copy(update={"zero_std_nm": zero_nm})
        vessel = known.model_copy(update={"sensors": known.sensors.model_copy(update={"shaft_torque": gauge})})
        std[zero_nm] = found(fit_of(vessel, 1e-2), vessel)["w"].std
    assert np.sqrt(std[25.0] ** 2 - std[1e-3] ** 2) == pytest.approx(1.6 * 25.0 / TORQUE_NM, rel=0.2)


def test_mass_is_in_the_deviations(fitted):
    """The resistance goes with the mass, and the thrust deduction is 1 - R / T."""
    numbers = found(fitted, silent())
    mass = VESSEL.hull.surging_mass_std_kg / VESSEL.hull.surging_mass_kg
    assert numbers["R"].std / numbers["R"].value == pytest.approx(mass, rel=0.1)
    assert numbers["t"].std == pytest.approx((1.0 - TRUTH["t"]) * mass, rel=0.1)


def test_nothing_is_said_without_curve_log_or_way(fitted):
    fit, signals = fitted
    unknown = VESSEL.model_copy(update={"propeller": VESSEL.propeller.model_copy(update={"series": None})})
    assert ship_numbers(fit, signals, unknown, rng=np.random.default_rng(1)) == ()
    moored = SimpleNamespace(working_point=signals.working_point, channels={})
    assert ship_numbers(fit, moored, VESSEL, rng=np.random.default_rng(1)) == ()


def test_what_sensors_leave_open_is_free_underway_only():
    structure = shipped_structure("FREE-LOG")
    assert of_vessel(structure, load_vessel("stan-tug-1205")) is structure
    opened = {parameter.name for parameter in of_vessel(structure, VESSEL).free}
    assert opened - {parameter.name for parameter in structure.free} == {"k_q", "t_log"}
    point = SimpleNamespace(engine_speed_rev_s=SPEED_REV_S, shaft_torque_nm=TORQUE_NM)
    priors = priors_from_vessel(of_vessel(structure, VESSEL), VESSEL, point)
    assert priors["t_log"] == Prior(0.0, 0.1, sources={"log latency": 0.1})
    assert priors["k_q"].std == pytest.approx(2.0 * 25.0 / TORQUE_NM)

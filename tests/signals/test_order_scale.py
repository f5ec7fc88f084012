"""Orders in the torque against the count of a pick-up and the gear ratio: the truth is the angle of the shafts."""

import numpy as np
import pytest

from shaftprint.signals._channel_signals import SpeedSignal
from shaftprint.signals._gaps import EVERYTHING
from shaftprint.signals._order_scale import reasons_of_orders
from shaftprint.signals.levels._order_lines import order_lines
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
RATIO, RATE_HZ = 3.82, 200.0
TIME_S = np.arange(0.0, 300.0, 1.0 / RATE_HZ)
# two speeds, and a motion of 3 % at each
ENGINE_REV_S = np.where(TIME_S < 150.0, 20.0, 15.0) * (1.0 + 0.03 * np.sin(0.7 * TIME_S) + 0.01 * np.sin(3.1 * TIME_S))
ENGINE_TURNS = np.cumsum(ENGINE_REV_S) / RATE_HZ
OF_ENGINE, OF_PROPELLER = {0.5: 0.03, 1.0: 0.01, 2.0: 0.02}, {1: 0.02, 3: 0.05, 6: 0.02}


def vessel_of(shaft, pulses, *, of=VESSEL, beside=()):
    speed = of.sensors.speed[0].model_copy(update={"shaft": shaft, "pulses_per_revolution": pulses, "unit": "V"})
    return of.model_copy(update={"sensors": of.sensors.model_copy(update={"speed": (speed, *beside)})})


def reasons_of(vessel, *, shown=1.0, ratio=RATIO, engine=OF_ENGINE, propeller=OF_PROPELLER, further=0.0):
    """What is said of a speed shown so many times too large, with orders of a true engine, gear and propeller."""
    places = {**engine, **{order / ratio: size for order, size in propeller.items()}}
    orders = sum(size * np.cos(2.0 * np.pi * place * ENGINE_TURNS + place) for place, size in places.items())
    load = 1.0 + orders + 0.03 * np.random.default_rng(3).normal(size=TIME_S.size) + further
    speed = SpeedSignal(
        name=vessel.sensors.speed[0].name,
        channel="PTM",
        values=shown * ENGINE_REV_S,
        reference=20.0,
        pulse_rate_hz=500.0,
    )
    torque_nm = 2000.0 * ENGINE_REV_S**2 * load
    return reasons_of_orders(speed, torque_nm, vessel, rate_hz=RATE_HZ, start_s=0.0, coverage=EVERYTHING)


@pytest.mark.parametrize(("shaft", "pulses"), [("engine", 60), ("propeller", 24)])
@pytest.mark.parametrize("more", [-1, 1])
def test_a_tooth_more_or_less_is_counted_by_the_orders(shaft, pulses, more):
    (reason,) = reasons_of(vessel_of(shaft, pulses), shown=(pulses + more) / pulses)
    assert reason.kind == "speed scale"
    assert f"{pulses} is stated, {pulses + more} would fit" in reason.sentence


def test_a_motor_without_gears_has_no_ratio_that_could_be_wrong():
    ferry = load_vessel("e-ferry-ellen")
    assert (ferry.gearbox.ratio, ferry.engine) == (1.0, None)
    ferry = ferry.model_copy(update={"propeller": ferry.propeller.model_copy(update={"blades": 2})})
    orders = {"ratio": 1.0, "engine": {}, "propeller": {1: 0.02, 2: 0.05}}
    (reason,) = reasons_of(vessel_of("engine", 24, of=ferry), shown=25 / 24, **orders)
    assert reason.kind == "speed scale"
    assert "24 is stated, 25 would fit" in reason.sentence
    assert "gear" not in reason.sentence
    assert reasons_of(vessel_of("engine", 24, of=ferry), **orders) == ()


def test_of_two_pick_ups_that_differ_by_one_tooth_of_many_it_is_not_said_that_they_agree():
    """Up to one per cent apart they are compared in a finding alone."""
    another = VESSEL.sensors.speed[0].model_copy(update={"name": "n_2", "channel": "PTM_2"})
    (reason,) = reasons_of(vessel_of("engine", 120, beside=[another]), shown=121 / 120)
    assert "120 is stated, 121 would fit" in reason.sentence
    assert "agree" not in reason.sentence


def test_a_gear_ratio_is_told_by_the_orders_of_the_other_shaft():
    for shaft, kind, shown in (("engine", "gear ratio", 1.0), ("propeller", "speed scale", 3.82 / 3.9)):
        # behind the gears the engine's speed itself is off
        (reason,) = reasons_of(vessel_of(shaft, 60), ratio=3.9, shown=shown)
        fitting = float(reason.sentence.split("3.82 is stated, ")[1].split()[0])
        assert (reason.kind, fitting) == (kind, pytest.approx(3.9, rel=5e-4))


@pytest.mark.parametrize("factor", [7 / 9, 1.2, 1.4])
@pytest.mark.parametrize("pulses", [12, 60])
def test_a_ratio_that_is_far_off_is_none_of_the_speed(factor, pulses):
    """An order of firing stands where 5/2 would by a factor of 1.2, and 12 pulses would be 10: more lines tell."""
    engine = {0.5: 0.03, 3.0: 0.03}
    (reason,) = reasons_of(vessel_of("engine", pulses), ratio=RATIO / factor, engine=engine)
    fitting = float(reason.sentence.split("3.82 is stated, ")[1].split()[0])
    assert (reason.kind, fitting) == ("gear ratio", pytest.approx(RATIO / factor, rel=1e-3))
    assert "pulses_per_revolution" not in reason.sentence


@pytest.mark.parametrize("blades", [4, 5])
@pytest.mark.parametrize("ratio", [5.2, 3.1])
def test_another_ratio_with_other_blades_is_another_ship(ratio, blades):
    """The tug has three blades and 3.82: of another ship shaft order, blades and their double stand elsewhere."""
    (reason,) = reasons_of(vessel_of("engine", 60), ratio=ratio, propeller={1: 0.02, blades: 0.05, 2 * blades: 0.02})
    fitting = float(reason.sentence.split("3.82 is stated, ")[1].split()[0])
    assert (reason.kind, fitting) == ("gear ratio", pytest.approx(ratio, rel=1e-3))
    assert f"would fit, with {blades} blades; check whether the vessel file is of this ship" in reason.sentence


@pytest.mark.parametrize("pulses", [10, 14])
def test_a_count_that_is_far_off_is_none_of_the_gears(pulses):
    engine = {0.5: 0.03, 3.0: 0.03}
    (reason,) = reasons_of(vessel_of("engine", 12), shown=pulses / 12, engine=engine)
    assert (reason.kind, f"12 is stated, {pulses} would fit" in reason.sentence) == ("speed scale", True)


@pytest.mark.parametrize("shaft", ["engine", "propeller"])
@pytest.mark.parametrize(
    "orders",
    [
        {},
        {"engine": {}},
        {"propeller": {}},
        {"engine": {}, "propeller": {}},
        # five blades where the vessel file has another number, and multiples of which it knows nothing
        {"engine": {}, "propeller": {5: 0.05, 10: 0.02}},
        {"engine": {2.5: 0.02, 3.5: 0.02}, "propeller": {2: 0.02, 4: 0.02}},
        # hum, and pumps that turn at their own speed
        {
            "engine": {},
            "further": 0.03 * np.sin(2.0 * np.pi * 50.0 * TIME_S) + 0.03 * np.sin(2.0 * np.pi * 16.7 * TIME_S),
        },
    ],
)
def test_a_speed_that_is_right_is_right_whatever_stands_in_the_torque(shaft, orders):
    assert reasons_of(vessel_of(shaft, 24), **orders) == ()


def test_a_ratio_of_three_digits_is_exact_enough():
    assert reasons_of(vessel_of("engine", 60), ratio=3.8167) == ()


def test_a_minute_in_which_nothing_moves_hides_no_line():
    """As before a test that was simulated without noise: torque and speed are one number each."""
    moves = TIME_S >= 60.0
    speed = np.where(moves, ENGINE_REV_S, 20.0)
    noise = 0.03 * np.random.default_rng(3).normal(size=TIME_S.size)
    load = 1.0 + moves * (0.05 * np.cos(2.0 * np.pi * np.cumsum(speed) / RATE_HZ) + noise)
    grid = {"rate_hz": RATE_HZ, "start_s": 0.0, "coverage": EVERYTHING}
    lines = order_lines(speed, 2000.0 * speed**2 * load, **grid)
    assert lines.order[np.argmax(lines.size)] == pytest.approx(1.0, abs=lines.resolution)
    assert order_lines(np.full(TIME_S.size, 20.0), np.full(TIME_S.size, 8e5), **grid) is None

"""Orders of a shaft line, counted by hand."""

import pytest

from shaftprint.vessel import load_vessel


def test_orders_of_the_stan_tug_stand_where_counting_puts_them():
    vessel = load_vessel("stan-tug-1205")
    hertz = {order.name: order.per_engine_turn * 1183.8 / 60.0 for order in vessel.orders}
    # 19.73 engine turns a second, gear ratio 3.82, three blades, six cylinders of four strokes
    assert hertz == pytest.approx(
        {
            "shaft order 1": 5.1649,
            "engine order 1/2": 9.865,
            "blade rate": 15.4948,
            "engine order 1": 19.73,
            "engine order 3/2": 29.595,
            "twice the blade rate": 30.9895,
            "engine order 2": 39.46,
            "engine order 5/2": 49.325,
            "engine order 3": 59.19,
        },
        rel=1e-5,
    )
    assert [order.shaft for order in vessel.orders if "engine" in order.name] == 6 * ["engine"]


def test_a_two_stroke_engine_fires_every_cylinder_in_each_turn():
    vessel = load_vessel("stan-tug-1205")
    engine = vessel.engine.model_copy(update={"strokes_per_cycle": 2, "cylinders": 4})
    orders = vessel.model_copy(update={"engine": engine}).orders
    assert [order.per_engine_turn for order in orders if order.shaft == "engine"] == [1.0, 2.0, 3.0, 4.0]

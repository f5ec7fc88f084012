"""Drive files of earlier versions, which called states after the kinds of their blocks."""

import pytest

from shaftprint.bench._former_states import start_by_names_of_today
from shaftprint.drive import load_drive

BLOCKS = (
    ("way", "integrator", ["f"], ""),
    ("felt", "first-order-lag", ["way"], "time = 0.1"),
    ("weighed", "first-order-lag", ["felt"], "time = 0.1, gain = 3.0"),
    ("swing", "second-order-lag", ["weighed"], "frequency = 3.0, damping = 0.5"),
    ("dry", "coulomb-friction", ["v"], "size = 1.0, yielding = 0.02"),
    ("asked", "pi", ["swing"], "proportional = 2.0, integral = 1.0"),
    ("v", "integrator", ["asked", "-dry"], "gain = 2.0"),
)
TODAY = ("way", "felt", "weighed", "swing", "swing lag rate", "dry bristles", "asked integral", "v")
# As the version before named them, numbered from the second of a kind on.
FORMER = ("sum", "lag", "lag 2", "lag 3", "lag rate", "bristles", "sum 2", "sum 3")


def drive_of(folder, start):
    rows = ['name = "x"\n[[inputs]]\nname = "f"\nchannel = "f"\nunit = "N"']
    rows.append('[[outputs]]\nname = "v"\nchannel = "v"\nunit = "m/s"')
    rows += [
        f'[[blocks]]\noutput = "{output}"\nkind = "{kind}"\ninputs = {inputs}\nparameters = {{ {values} }}'
        for output, kind, inputs, values in BLOCKS
    ]
    rows += [f'[[start]]\nname = "{name}"\nvalue = {value}' for name, value in start.items()]
    path = folder / "x.toml"
    path.write_text("\n".join([*rows, '[fit]\nstart = "known"\n']), encoding="utf-8")
    return load_drive(path)


def test_former_names_of_states_are_put_into_those_of_today(tmp_path):
    drive = drive_of(tmp_path, dict.fromkeys(FORMER, 0.0))
    assert tuple(start_by_names_of_today(drive, TODAY)) == TODAY


def test_names_of_today_stay(tmp_path):
    values = {name: float(place) for place, name in enumerate(TODAY)}
    assert start_by_names_of_today(drive_of(tmp_path, values), TODAY) == values


@pytest.mark.parametrize(("former", "today"), [("sum 3", "v"), ("lag", "felt"), ("lag 2", "lag 2"), ("x", "x")])
def test_of_a_lag_with_a_gain_zero_alone_means_the_same(tmp_path, former, today):
    assert start_by_names_of_today(drive_of(tmp_path, {former: 1.5}), TODAY) == {today: 1.5}

"""What the blocks of a drive file do: against closed forms, in time, for small signals and as Modelica text."""

import numpy as np
import pytest
from scipy import signal

from shaftprint.bench._composed import composed
from shaftprint.drive import load_drive
from shaftprint.errors import SettingsError
from shaftprint.simulation import linearise, simulate
from shaftprint.simulation._equilibrium import state_names

T = np.arange(400) * 0.01
SWING = 2.0 * np.sin(2.0 * np.pi * 0.7 * T)


def text_of(outputs, blocks, parameters=(), fit=""):
    """Return the text of a drive file with the inputs u and v: rows of blocks, and of names, units, bounds, values."""
    rows = ['name = "x"\n']
    rows += [f'[[inputs]]\nname = "{name}"\nchannel = "{name}"\nunit = "N"\n' for name in ("u", "v")]
    rows += [f'[[outputs]]\nname = "{name}"\nchannel = "{name}"\nunit = "m/s"\n' for name in outputs]
    rows += [f'[[blocks]]\noutput = "{output}"\nkind = "{kind}"\n{row}\n' for output, kind, row in blocks]
    rows += [
        f'[[parameters]]\nname = "{name}"\nunit = "{unit}"\nlower = {lower}\nupper = {upper}\nvalue = {value}\n'
        'meaning = "of the axis"\n'
        for name, unit, lower, upper, value in parameters
    ]
    return "\n".join([*rows, fit])


@pytest.fixture
def read(tmp_path):
    def read_text(text):
        path = tmp_path / "blocks.toml"
        path.write_text(text, encoding="utf-8")
        return load_drive(path)

    return read_text


def moved(line, inputs, **options):
    return simulate(line, line.vector({}), T, inputs, **options).outputs


STATIC = (
    ("bias", "constant", 'parameters = { value = "c" }'),
    ("size", "abs", 'inputs = ["u"]'),
    ("times", "product", 'inputs = ["u", "-v", "bias"]'),
    ("cube", "power", 'inputs = ["u"]\nexponent = 3'),
    ("propeller", "power", 'inputs = ["u"]\nexponent = 2.0\nkeeps_sign = true'),
    ("broken", "power", 'inputs = ["u"]\nexponent = 1.5\nkeeps_sign = true'),
    ("corner", "table", 'inputs = ["u"]\npoints = [[-1, -3.0], [0.0, 0.0], [1.0, 0.5]]'),
)
CONSTANT = (("c", "N", -10.0, 10.0, 0.25),)


def laws(u, v):
    """Return what the static blocks give, written once more."""
    return {
        "bias": np.full(u.shape, 0.25),
        "size": np.abs(u),
        "times": -0.25 * u * v,
        "cube": u**3,
        "propeller": u * np.abs(u),
        "broken": np.sign(u) * np.abs(u) ** 1.5,
        "corner": np.interp(u, [-1.0, 0.0, 1.0], [-3.0, 0.0, 0.5]),
    }


@pytest.mark.slow
def test_blocks_without_memory_do_as_their_names_say(read):
    line = composed(read(text_of([output for output, *_ in STATIC], STATIC, CONSTANT)))
    other = np.cos(3.0 * T)
    found = moved(line, {"u": SWING, "v": other})
    for name, expected in laws(SWING, other).items():
        np.testing.assert_allclose(found[name], expected, rtol=1e-12, atol=1e-12, err_msg=name)


def test_blocks_without_memory_have_their_slopes_as_gains_of_small_signals(read):
    """At u = 0.8, v = 0.5: d/du of each law, by hand."""
    line = composed(read(text_of([output for output, *_ in STATIC], STATIC, CONSTANT)))
    about = linearise(line, line.vector({}), {"u": 0.8, "v": 0.5})
    gains = about.response(1j)
    expected = {
        "bias": 0.0,
        "size": 1.0,
        "times": -0.125,
        "cube": 3.0 * 0.64,
        "propeller": 1.6,
        "broken": 1.5 * 0.8**0.5,
        "corner": 0.5,
    }
    names = list(line.outputs)
    for name, slope in expected.items():
        assert gains[names.index(name), 0] == pytest.approx(slope), name


AXIS = (
    ("offset", "constant", 'parameters = { value = "F_0" }'),
    ("drag", "gain", 'inputs = ["w"]\nparameters = { gain = "d" }'),
    ("w", "inertia", 'inputs = ["u", "v", "offset", "-drag"]\nparameters = { inertia = "J" }'),
    ("shown", "sum", 'inputs = ["w"]'),
)
AXIS_PARAMETERS = (
    ("F_0", "N", -10.0, 10.0, -1.5),
    ("d", "N s/m", 0.1, 100.0, 4.0),
    ("J", "kg", 0.1, 100.0, 3.0),
)


@pytest.mark.slow
def test_an_inertia_goes_by_itself_and_a_constant_drives_it(read):
    """``J dw/dt = u + F_0 - d w`` from rest, with a force of 8: ``w = 6.5 / 4 (1 - exp(-4 t / 3))``."""
    line = composed(read(text_of(["w", "shown"], AXIS, AXIS_PARAMETERS)))
    found = moved(line, {"u": np.full(T.size, 8.0), "v": np.zeros(T.size)}, initial=np.zeros(1))
    np.testing.assert_allclose(found["w"], 6.5 / 4.0 * -np.expm1(-4.0 * T / 3.0), rtol=1e-6, atol=1e-9)
    assert found["w"] == pytest.approx(found["shown"])
    gain = linearise(line, line.vector({}), {"u": 8.0, "v": 0.0}).response(2j)
    assert gain[0, 0] == pytest.approx(1.0 / (3.0 * 2j + 4.0))


RATIO = 'inputs = ["u"]\nnumerator = ["b", 5.0]\ndenominator = [2.0, "a", 9.0]'


@pytest.mark.slow
def test_a_ratio_of_polynomials(read):
    """``(b s + 5) / (2 s^2 + a s + 9)`` as SciPy moves it, and with as many zeros as poles."""
    equal = 'inputs = ["u"]\nnumerator = [3.0, 1.0]\ndenominator = [0.5, 1.0]'
    blocks = (("y", "ratio", RATIO), ("z", "ratio", equal))
    line = composed(read(text_of(["y", "z"], blocks, (("b", "-", -9.0, 9.0, 1.2), ("a", "-", 0.0, 9.0, 0.8)))))
    found = moved(line, {"u": SWING, "v": 0.0 * T}, initial=np.zeros(3))
    for name, top, bottom in (("y", [1.2, 5.0], [2.0, 0.8, 9.0]), ("z", [3.0, 1.0], [0.5, 1.0])):
        _, expected, _ = signal.lsim((top, bottom), SWING, T)
        np.testing.assert_allclose(found[name], expected, atol=2e-5 * np.ptp(expected))


@pytest.mark.slow
def test_friction_of_two_sizes(read):
    """2 forward and 0.7 backward, at speeds that are given; held, it holds up to the size of each way."""
    row = 'inputs = ["u"]\nparameters = { size = 2.0, size-backward = 0.7, yielding = 1e-3 }'
    fading = row.replace("yielding", "breakaway = 1.5, fading-speed = 0.01, yielding")
    blocks = (("f", "coulomb-friction", row), ("g", "stribeck-friction", fading))
    line = composed(read(text_of(["f", "g"], blocks)))
    found = moved(line, {"u": np.where(T < 2.0, 3.0, -3.0), "v": 0.0 * T}, longest_step_s=1e-3)
    for name in ("f", "g"):
        assert found[name][50:199] == pytest.approx(2.0, rel=1e-6)
        assert found[name][220:] == pytest.approx(-0.7, rel=1e-6)


@pytest.mark.slow
def test_states_are_called_after_their_blocks(read):
    blocks = (
        ("w", "inertia", 'inputs = ["u", "-friction"]\nparameters = { inertia = 2.0 }'),
        ("friction", "coulomb-friction", 'inputs = ["w"]\nparameters = { size = 1.0, yielding = 1e-3 }'),
        ("way", "integrator", 'inputs = ["w"]'),
        ("late", "first-order-lag", 'inputs = ["way"]\nparameters = { time = 0.1, gain = 3.0 }'),
        ("swing", "second-order-lag", 'inputs = ["v"]\nparameters = { frequency = 9.0, damping = 0.1 }'),
        ("asked", "pi", 'inputs = ["v", "-way"]\nparameters = { proportional = 1.0, integral = 2.0 }'),
        ("shaped", "ratio", 'inputs = ["v"]\nnumerator = [1.0]\ndenominator = [1.0, 2.0, 3.0]'),
    )
    line = composed(read(text_of(["late", "swing", "asked", "shaped"], blocks)))
    names = state_names(line, line.vector({}))
    assert set(names) == {
        "w",
        "friction bristles",
        "way",
        "late",
        "swing",
        "swing lag rate",
        "asked integral",
        "shaped",
        "shaped state",
    }
    start = np.array([{"late": 5.0, "swing": -2.0}.get(name, 0.0) for name in names])
    found = moved(line, {"u": 0.0 * T, "v": 0.0 * T}, initial=start, longest_step_s=1e-3)
    # what stands there is what comes out, whatever the gain of the lag is
    assert (found["late"][0], found["swing"][0]) == (5.0, -2.0)


@pytest.mark.parametrize(
    ("block", "words"),
    [
        (
            ("y", "constant", 'inputs = ["u"]\nparameters = { value = 1.0 }'),
            "expected no inputs of a constant, found u",
        ),
        (("y", "product", 'inputs = ["u"]'), "expected two inputs or more of product, found u"),
        (("y", "gain", "parameters = { gain = 1.0 }"), "expected one input or more of gain, found none"),
        (("y", "power", 'inputs = ["u"]'), "expected exponent of power, found none"),
        (
            ("y", "power", 'inputs = ["u"]\nexponent = 1.5'),
            "expected a whole exponent, or keeps_sign = true, found 1.5",
        ),
        (
            ("y", "power", 'inputs = ["u"]\nexponent = 0.5\nkeeps_sign = true'),
            "expected a number not less than 1, found 0.5",
        ),
        (("y", "sum", 'inputs = ["u"]\nkeeps_sign = true'), "expected no keeps_sign of sum"),
        (("y", "abs", 'inputs = ["u"]\npoints = [[0, 0], [1, 1]]'), "expected no points of abs"),
        (("y", "table", 'inputs = ["u"]\npoints = [[0, 0], [0, 1]]'), "expected two points or more, each further"),
        (("y", "ratio", 'inputs = ["u"]\nnumerator = [1, 2, 3]\ndenominator = [1, 2]'), "numerator of no higher power"),
        (
            ("y", "ratio", 'inputs = ["u"]\nnumerator = [1]\ndenominator = [0, 2]'),
            "first coefficient of the denominator",
        ),
        (("y", "ratio", 'inputs = ["u"]\nnumerator = ["k"]\ndenominator = [1, 2]'), "found 'k'"),
    ],
)
def test_a_block_that_cannot_be_is_refused(read, block, words):
    with pytest.raises(SettingsError) as refused:
        composed(read(text_of(["y"], [block])))
    assert words in " ".join(str(refused.value).split())

"""A lag behind a delay, from voltage to speed: its drive file, its numbers and its response."""

import numpy as np

GAIN, TIME_S, DELAY_S = 3.0, 0.05, 0.004
TRUE = {"K": GAIN, "T": TIME_S, "t_d": DELAY_S}
PARAMETERS = "".join(
    f'\n[[parameters]]\nname = "{name}"\nunit = "{unit}"\nlower = {lower}\nupper = {upper}\nvalue = {value}\n'
    'meaning = "of the lag"\n'
    for name, unit, lower, upper, value in (
        ("K", "rpm/mV", 0.1, 30.0, 1.0),
        ("T", "s", 0.001, 1.0, 0.1),
        ("t_d", "s", 0.0, 0.1, 0.001),
    )
)


def late_lag(*, channels=False):
    """Return the drive file; ``channels``: with the channels of records."""
    u, w = ('\nchannel = "u"', '\nchannel = "w"') if channels else ("", "")
    return f"""\
name = "lag"

[[inputs]]
name = "u"{u}
unit = "mV"

[[outputs]]
name = "w"{w}
unit = "rpm"

[[blocks]]
output = "lag"
kind = "first-order-lag"
inputs = ["u"]
parameters = {{ gain = "K", time = "T" }}

[[blocks]]
output = "w"
kind = "delay"
inputs = ["lag"]
parameters = {{ time = "t_d" }}
{PARAMETERS}"""


def lag(hertz):
    """Return its frequency response."""
    s = 2j * np.pi * np.asarray(hertz)
    return GAIN * np.exp(-DELAY_S * s) / (TIME_S * s + 1.0)

#!/usr/bin/env bash
# About: pint 0.25.3, quantities 0.16.4, unyt 3.2.0, astropy 8.0.2: 60 rpm in hertz
# Guess: 60 rpm are 1 Hz, in each of them.
# What happens: pint and quantities count a radian as 1 and a hertz as 1/s, and answer 6.283 Hz. unyt and astropy refuse to convert
#   a turning speed to a frequency at all (astropy knows no rpm: 60 cycles a minute). None of the four says 1 Hz.
. "$(dirname "$0")/_setup.sh"
packages pint==0.25.3 quantities==0.16.4 unyt==3.2.0 astropy==8.0.2
run <<'PY'
import math

import astropy.units
import pint
import quantities
import unyt
from find import seen

in_pint = pint.UnitRegistry()("60 rpm").to("Hz").magnitude
in_quantities = float((60 * quantities.rpm).rescale("Hz").magnitude)


def refused(convert):
    try:
        convert()
    except Exception as error:
        return type(error).__name__
    return ""


by_unyt = refused(lambda: unyt.unyt_quantity(60, "rpm").to("Hz"))
by_astropy = refused(lambda: (60 * astropy.units.cycle / astropy.units.min).to("Hz"))
seen(f"pint:       {in_pint:.4f} Hz", math.isclose(in_pint, 2 * math.pi, rel_tol=1e-6))
seen(f"quantities: {in_quantities:.4f} Hz", math.isclose(in_quantities, 2 * math.pi, rel_tol=1e-6))
seen(f"unyt:       {by_unyt}", by_unyt == "UnitConversionError")
seen(f"astropy:    {by_astropy}", by_astropy == "UnitConversionError")
PY

#!/usr/bin/env bash
# About: pint 0.25.3, units as loggers and data sheets write them: Nm, kNm, ftlb, PS, ton, U/min
# Guess: what is written without a blank is either read as meant or refused.
# What happens: no error. Nm is a number density times a metre (N for "number"), ftlb a femto-troy-pound, PS a petasiemens, ton the American one of 907 kg, hp the one of
#   745.7 W, U/min an amount of enzyme. Only the conversion to N m fails, and not where masses or powers are wanted.
. "$(dirname "$0")/_setup.sh"
packages pint==0.25.3
run <<'PY'
import pint
from find import seen

units = pint.UnitRegistry()
expected = {
    "Nm": "number_meter",
    "kNm": "kilonumber_meter",
    "ftlb": "femtotroy_pound",
    "PS": "petasiemens",
    "U/min": "enzyme_unit / minute",
}
for text, name in expected.items():
    seen(f"{text:6} -> {units(text).units}", str(units(text).units) == name)
seen(f"1 ton  -> {units('ton').to('kg').magnitude:.1f} kg", abs(units("ton").to("kg").magnitude - 907.18) < 0.01)
seen(f"1 hp   -> {units('hp').to('W').magnitude:.1f} W", abs(units("hp").to("W").magnitude - 745.7) < 0.01)
seen(f"N m    -> {units('N m').units}", str(units("N m").units) == "meter * newton" or str(units("N m").units) == "newton * meter")
PY

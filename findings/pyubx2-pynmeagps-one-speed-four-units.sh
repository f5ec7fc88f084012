#!/usr/bin/env bash
# About: pyubx2 1.4.0 (u-blox receivers) and pynmeagps 1.1.8: one speed over ground of 5.144 m/s in NAV-PVT, NAV-VELNED and a VTG sentence, and the times beside it
# Guess: speeds come in m/s, or in one unit per package, scaled as the headings and positions beside them are.
# What happens: places and headings are scaled to degrees, speeds are not: 5144 (mm/s) in NAV-PVT, 514 (cm/s) in NAV-VELNED; VTG gives knots and km/h. No unit is given with any of the
#   first two. The part below a second, nano, may be negative: 9:01:00 with -200000000 is 9:00:59.8. pynmeagps' haversine is in km, its planar in m.
. "$(dirname "$0")/_setup.sh"
packages pyubx2==1.4.0 pynmeagps==1.1.8
run <<'PY'
from find import seen
from pynmeagps import NMEAReader, haversine, planar
from pyubx2 import GET, UBXMessage, UBXReader

told = {"year": 2026, "month": 3, "day": 5, "hour": 9, "min": 1, "second": 0, "nano": -200_000_000}
message = UBXMessage("NAV", "NAV-PVT", GET, **told, lat=53.5, lon=9.9, gSpeed=5144, headMot=90.5)
place = UBXReader.parse(message.serialize())
course = UBXReader.parse(UBXMessage("NAV", "NAV-VELNED", GET, gSpeed=514, heading=90.5).serialize())
line = NMEAReader.parse(b"$GPVTG,90.5,T,,M,10.0,N,18.5,K,A*1D\r\n", validate=0)
seen(f"NAV-PVT:    heading {place.headMot}, speed {place.gSpeed}", (place.headMot, place.gSpeed) == (90.5, 5144))
seen(f"NAV-VELNED: heading {course.heading}, speed {course.gSpeed}", (course.heading, course.gSpeed) == (90.5, 514))
seen(f"VTG:        heading {line.cogt}, speed {line.sogn} and {line.sogk}", (line.sogn, line.sogk) == (10.0, 18.5))
clock = (place.hour, place.min, place.second, place.nano)
seen(f"time of NAV-PVT: {clock}", clock == (9, 1, 0, -200_000_000))
apart = haversine(53, 9, 53.001, 9), planar(53, 9, 53.001, 9)
seen(f"a thousandth of a degree: {apart[0]:.4f} and {apart[1]:.1f}", abs(apart[0] - 0.1113) < 1e-3 and abs(apart[1] - 111.3) < 0.5)
PY

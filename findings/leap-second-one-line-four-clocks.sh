#!/usr/bin/env bash
# About: ZDA of a GPS receiver in the leap second 23:59:60 of 31 December 2016; pynmea2 1.19.0, pynmeagps 1.1.8, pandas 3.1.1, polars 2.1.0
# Guess: each gives a time one second after 23:59:59, or says that it cannot.
# What happens: pynmea2 gives the text '235960.00' where it gives a time for every other second, pynmeagps an empty text, polars midnight,
#   which comes again a second later; pandas alone refuses.
. "$(dirname "$0")/_setup.sh"
packages pynmea2==1.19.0 pynmeagps==1.1.8 pandas==3.1.1 polars==2.1.0 numpy==2.3.5
run <<'PY'
from functools import reduce

import pandas as pd
import polars as pl
import pynmea2
from find import seen
from pynmeagps import NMEAReader


def sentence(clock):
    """Return the sentence of a time of day, with its check sum."""
    body = f"GPZDA,{clock},31,12,2016,00,00"
    return f"${body}*{reduce(lambda left, right: left ^ ord(right), body, 0):02X}"


usual, leap = sentence("235959.00"), sentence("235960.00")
print("pynmea2:", repr(pynmea2.parse(usual).timestamp), repr(pynmea2.parse(leap).timestamp))
print("pynmeagps:", repr(NMEAReader.parse(usual).time), repr(NMEAReader.parse(leap).time))
seen("pynmea2: text", pynmea2.parse(leap).timestamp == "235960.00" and pynmea2.parse(usual).timestamp.second == 59)
seen("pynmeagps: empty text", NMEAReader.parse(leap).time == "" and NMEAReader.parse(usual).time.second == 59)
stamps = pl.Series(["2016-12-31T23:59:60", "2017-01-01T00:00:00"]).str.to_datetime()
seen(f"polars: {stamps.to_list()}", stamps[0] == stamps[1])
try:
    refused = pd.Timestamp("2016-12-31T23:59:60") is None
except ValueError as error:
    print("pandas:", error)
    refused = True
seen("pandas refuses", refused)
PY

#!/usr/bin/env bash
# About: traces 0.7.0, ticts 0.6.1 and pandas 3.1.1: power as the product of a torque every 0.1 s and a speed every second that begins half a second later
# Guess: three libraries for uneven series, one product: the last torque times the last speed, from 0.5 s on.
# What happens: ticts gives that. pandas gives a row for each stamp of either and no value in any, since none are equal. traces raises a TypeError: before its first stamp the speed is None.
. "$(dirname "$0")/_setup.sh"
packages traces==0.7.0 ticts==0.6.1 pytz pandas==3.1.1 numpy==2.3.5
run <<'PY'
import pandas as pd
import ticts
import traces
from find import seen

zero = pd.Timestamp("2026-03-05 09:00", tz="UTC")
torque = {zero + pd.Timedelta(seconds=0.05 + 0.1 * k): 1000.0 + k for k in range(20)}
speed = {zero + pd.Timedelta(seconds=0.5 + k): 150.0 for k in range(2)}
power = ticts.TimeSeries(torque) * ticts.TimeSeries(speed)
first = next(iter(power.items()))
seen(f"ticts:  {len(power)} values, the first {first[1]:.0f} W at {(first[0] - zero).total_seconds()} s", first == (zero + pd.Timedelta(seconds=0.5), 150_600.0))
power = pd.Series(torque) * pd.Series(speed)
seen(f"pandas: {power.size} rows, {power.count()} with a value", (power.size, power.count()) == (22, 0))
try:
    power = traces.TimeSeries(torque).multiply(traces.TimeSeries(speed))
    found = f"{power.n_measurements()} values"
except TypeError as error:
    found = f"TypeError: {error}"
seen(f"traces: {found}", found.startswith("TypeError"))
PY

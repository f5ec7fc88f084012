#!/usr/bin/env bash
# About: DuckDB 2.0.1, pandas 3.1.1 and polars 2.1.0: a log with dates such as 03/05/2026
# Guess: all read the same day, or say that it may be two.
# What happens: DuckDB and polars take the day first (3 May), pandas the month (5 March), without a word. With a 13th among the days, so that it can be told, pandas stops there and the
#   others go on; where it can be told to be the other way, DuckDB and polars give text, and pandas is right.
. "$(dirname "$0")/_setup.sh"
packages duckdb==2.0.1 pandas==3.1.1 polars==2.1.0
run <<'PY'
import duckdb
import pandas
import polars
from find import seen


def write(name, form, days):
    with open(name, "w") as file:
        file.write("time,torque\n")
        file.writelines(form.format(day=day) + f" 09:00:00,{day}.5\n" for day in days)


def by_pandas(name):
    try:
        return str(pandas.to_datetime(pandas.read_csv(name)["time"])[0])
    except ValueError:
        return "stops"


write("short.csv", "{day:02d}/05/2026", (3, 4, 5))
write("long.csv", "{day:02d}/05/2026", (3, 4, 5, 13))
write("other.csv", "05/{day:02d}/2026", (3, 4, 5, 13))
for name, expected in (
    ("short.csv", ("2026-05-03 09:00:00", "2026-05-03 09:00:00", "2026-03-05 09:00:00")),
    ("long.csv", ("2026-05-03 09:00:00", "2026-05-03 09:00:00", "stops")),
    ("other.csv", ("05/03/2026 09:00:00", "05/03/2026 09:00:00", "2026-05-03 09:00:00")),
):
    in_polars = str(polars.read_csv(name, try_parse_dates=True)["time"][0])
    found = (str(duckdb.sql(f"select time from read_csv('{name}')").fetchall()[0][0]), in_polars, by_pandas(name))
    seen(f"{name:9}: DuckDB {found[0]}, polars {found[1]}, pandas {found[2]}", found == expected)
PY

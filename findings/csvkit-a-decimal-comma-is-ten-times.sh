#!/usr/bin/env bash
# About: csvkit 2.2.0 (agate 1.14), csvstat and in2csv on a table with ";" between columns and decimal commas
# Guess: 1500,5 is 1500.5, or text.
# What happens: the comma is taken for a mark of thousands wherever it stands: 1500,5 is 15005, -12,25 is -1225, 0,1 is 1; a torque written once as 12,5 and once as 12,50 is
#   125 and 1250. Right with --locale de_DE.
. "$(dirname "$0")/_setup.sh"
packages csvkit==2.2.0
printf 'speed;torque\n1500,5;-12,25\n1501,5;12,5\n1502,5;12,50\n' >"$scratch/log.csv"
run <<'PY'
import subprocess

from find import seen


def rows(*locale):
    text = subprocess.run(["venv/bin/in2csv", *locale, "-d", ";", "log.csv"], capture_output=True, text=True, check=True).stdout
    return [tuple(map(float, line.split(","))) for line in text.splitlines()[1:]]


def mean(*locale):
    text = subprocess.run(["venv/bin/csvstat", *locale, "-d", ";", "-c", "speed", "--mean", "log.csv"], capture_output=True, text=True, check=True).stdout
    return text.strip()


seen(f"in2csv: {rows()}", rows() == [(15005.0, -1225.0), (15015.0, 125.0), (15025.0, 1250.0)])
seen(f"csvstat --mean: {mean()}", mean().replace(",", "") == "15015")
german = rows("--locale", "de_DE")
seen(f"in2csv --locale de_DE: {german}", german == [(1500.5, -12.25), (1501.5, 12.5), (1502.5, 12.5)])
PY

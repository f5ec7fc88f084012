#!/usr/bin/env bash
# About: xlsx2csv 0.8.6 (openpyxl 3.1.5 writes the sheet)
# Guess: the CSV holds the numbers that the sheet holds.
# What happens: it holds what would be shown, and less: a time with the format "hh:mm:ss.000" is printed with .000 whatever its fraction, so that four rows at 4 Hz share a time;
#   -12345.678 in a column of one decimal is -12345.7; a plain cell has six decimals, so that 4e-7 is 0.
. "$(dirname "$0")/_setup.sh"
packages xlsx2csv==0.8.6 openpyxl==3.1.5
run <<'PY'
import datetime
import subprocess

import openpyxl
from find import seen

book = openpyxl.Workbook()
sheet = book.active
sheet.append(["time", "torque", "strain"])
start = datetime.datetime(2026, 11, 30, 12)
for number in range(4):
    sheet.append([start + datetime.timedelta(seconds=0.25 * number), -12345.678 - number, 4e-7 * (number + 1)])
for time, torque, _ in sheet.iter_rows(min_row=2):
    time.number_format, torque.number_format = "yyyy-mm-dd hh:mm:ss.000", "0.0"
book.save("log.xlsx")

rows = subprocess.run(["venv/bin/xlsx2csv", "log.xlsx"], capture_output=True, text=True, check=True).stdout.splitlines()[1:]
for line, (torque, strain) in zip(rows, (("-12345.7", "0"), ("-12346.7", "0.000001"), ("-12347.7", "0.000001"), ("-12348.7", "0.000002")), strict=True):
    seen(line, line == f"2026-11-30 12:00:00.000,{torque},{strain}")
PY

#!/usr/bin/env bash
# About: pandas 3.1.1, polars 2.1.0, pyarrow 26.0.1 on one CSV file of a C program on Windows, whose printf writes 1.#QNAN and 1.#INF
# Guess: each of the three reads a column of numbers, with no value at 1.#QNAN and infinity at 1.#INF.
# What happens: 1.#QNAN alone is no value for pandas and pyarrow; for polars the whole column is text. One overflow, 1.#INF,
#   makes it text in all three, in pandas with the texts '1.5' of rows that were numbers and a missing value at 1.#QNAN.
. "$(dirname "$0")/_setup.sh"
packages pandas==3.1.1 polars==2.1.0 pyarrow==26.0.1 numpy==2.3.5
run <<'PY'
import io

import pandas as pd
import polars as pl
import pyarrow.csv
from find import seen

lost = "t,M_s\n0,1.5\n1,1.#QNAN\n2,2.5\n"
over = lost.replace("2,2.5", "2,1.#INF\n3,2.5")


def kinds(text):
    """Return whether each reader has numbers."""
    return (
        pd.read_csv(io.StringIO(text))["M_s"].dtype.kind == "f",
        pl.read_csv(io.StringIO(text))["M_s"].dtype.is_numeric(),
        str(pyarrow.csv.read_csv(io.BytesIO(text.encode())).schema.field("M_s").type) == "double",
    )


seen(f"numbers with 1.#QNAN: pandas, polars, pyarrow {kinds(lost)}", kinds(lost) == (True, False, True))
seen(f"numbers with 1.#INF too: {kinds(over)}", kinds(over) == (False, False, False))
column = pd.read_csv(io.StringIO(over))["M_s"]
seen(f"pandas: {column.tolist()}", column[0] == "1.5" and pd.isna(column[1]))
PY

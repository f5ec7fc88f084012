import subprocess
import sys

from shaftprint.drift._dated import EVENTS
from shaftprint.store._nouns import KINDS


def test_the_store_keeps_what_drift_knows():
    assert tuple(EVENTS) == KINDS


def test_who_reads_a_store_loads_no_room_that_calculates():
    heavy = {"numpy", "pydantic", "alembic"}
    code = f"import sys, shaftprint.store.database as _; print(*sorted({heavy!r} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == []

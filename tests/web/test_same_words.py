"""What the server knows without loading the rooms that it comes from, held against them."""

import random
import subprocess
import sys
from importlib.resources import files

from shaftprint.catalogue import STRUCTURES as ALL_STRUCTURES
from shaftprint.settings import shipped_names
from shaftprint.vessel import is_imo_number as is_of_a_ship
from shaftprint.web.pages._recordings import CAMPAIGNS, STRUCTURES, VESSELS, is_imo_number


def test_files_that_come_with_the_program_are_those_of_the_forms():
    assert shipped_names(files("shaftprint.vessel") / "shipped") == VESSELS
    assert shipped_names(files("shaftprint.campaign") / "shipped") == CAMPAIGNS
    assert set(STRUCTURES) <= set(ALL_STRUCTURES)


def test_numbers_of_ships_are_checked_alike():
    rng = random.Random(4)  # noqa: S311
    for number in (*rng.sample(range(10**7), 3000), *range(9074720, 9074740)):
        assert is_imo_number(str(number)) == is_of_a_ship(number)
    assert not is_imo_number("٩٠٧٤٧٢٩")


def test_the_server_loads_nothing_that_calculates():
    heavy = {"numpy", "scipy", "pydantic", "matplotlib", "numba", "h5py", "alembic"}
    code = f"import sys, shaftprint.web, shaftprint.store.database; print(*sorted({heavy!r} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == []

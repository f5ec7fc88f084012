import pytest

from shaftprint.vessel import load_vessel


@pytest.fixture(scope="session")
def vessel():
    return load_vessel("stan-tug-1205")

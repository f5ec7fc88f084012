"""Libraries of links, each of an extra of its own."""

import importlib
from typing import Any, Final

from shaftprint.errors import RequestError

_EXTRAS: Final = {
    "asyncua": "opcua",
    "aiomqtt": "mqtt",
    "paho": "mqtt",
    "pymodbus": "modbus",
    "can": "can",
    "defusedxml": "mqtt",
}


def library(module: str, what: str) -> Any:
    """Import what a link needs.

    ``module``: its name. ``what``: for what, in words. Raises RequestError, with the extra to install, if it is not
    there.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        package = module.partition(".")[0]
        raise RequestError(
            f'expected {package} for {what}, found it not installed; pip install "shaftprint[{_EXTRAS[package]}]".'
        ) from None

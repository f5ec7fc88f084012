"""Options such as ``--prior g=0+-0.1`` and ``--hold v=1``: what is known of parameters before a fit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import click

from shaftprint.errors import IdentificationError
from shaftprint.late import late

with late():
    from shaftprint.identify.likelihood._prior import Prior


def named_prior(text: str) -> tuple[str, Prior]:
    """Return the name and the prior of ``NAME=MEAN+-STD``, a mean and a standard deviation.

    Raises click.BadParameter if the text is not of that form.
    """
    name, numbers = _split(text.replace("+/-", "+-"))
    mean, _, std = numbers.partition("+-")
    try:
        return name, Prior(mean=_number(mean), std=_number(std))
    except ValueError:
        raise click.BadParameter(
            f"expected a parameter, its mean and its standard deviation such as g=0+-0.1, found {text!r}."
        ) from None
    except IdentificationError as error:
        raise click.BadParameter(str(error)) from None


def named_value(text: str) -> tuple[str, float]:
    """Return the name and the number of ``NAME=VALUE``.

    Raises click.BadParameter if the text is not of that form.
    """
    name, number = _split(text)
    try:
        return name, _number(number)
    except ValueError:
        raise click.BadParameter(f"expected a parameter and its value such as v=1, found {text!r}.") from None


def by_name(context: click.Context, parameter: click.Parameter, pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    """Return values by name, as an option gives them that may be repeated; the last of a name counts."""
    return dict(pairs)


def named_variable(text: str) -> tuple[str, tuple[str, str]]:
    """Return the role, and name and unit, of ``ROLE=NAME [UNIT]``; the unit is empty where none is given.

    Raises click.BadParameter if the text is not of that form.
    """
    role, name = _split(text)
    title, bracket, unit = name.removesuffix("]").rpartition(" [")
    if bracket and name.endswith("]"):
        return role, (title.strip(), unit.strip())
    return role, (name.strip(), "")


def _split(text: str) -> tuple[str, str]:
    name, _, value = text.partition("=")
    return name.strip(), value.strip()


def _number(text: str) -> float:
    """Return a finite number.

    Raises ValueError if the text is anything else.
    """
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(text)
    return number


prior_option = click.option(
    "--prior",
    "priors",
    metavar="NAME=MEAN+-STD",
    type=named_prior,
    multiple=True,
    callback=by_name,
    help="What is known of a parameter beforehand, such as g=0+-0.1; instead of what the vessel file knows.",
)
hold_option = click.option(
    "--hold",
    "held",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    callback=by_name,
    help="Hold a parameter at a value.",
)

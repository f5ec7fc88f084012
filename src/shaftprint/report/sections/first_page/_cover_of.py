"""The first page from a fingerprint: every answer is one rule, and a point that is not fine says what to do."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain, to_digit_of, unit_text, with_deviation
from shaftprint.identify.judgement._main_numbers import main_in_words
from shaftprint.report._logo import drawn_logo
from shaftprint.report.sections._cover import Cover, overall
from shaftprint.report.sections.first_page._change_answer import change_answer
from shaftprint.report.sections.first_page._line_answers import hunting, inertia, other_contradictions, propeller
from shaftprint.report.sections.first_page._line_sketch import line_sketch
from shaftprint.report.sections.first_page._number_table import number_table
from shaftprint.report.sections.first_page._test_answers import (
    gauge,
    is_partial,
    measured,
    not_judged,
    predicts,
    usable,
)
from shaftprint.tables._conditions import ship_text, tested_text, water_facts

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.validation._validation import Validation
    from shaftprint.vessel._vessel import Vessel


WATT = 1000.0
"""Watts in a kilowatt."""
OPENING = (
    "Everything here holds at the working point. ± is one standard deviation; where a range is given, the true value "
    "lies in it in 95 of 100 tests."
)


def cover_of(
    fingerprint: "Fingerprint",
    validations: "Sequence[Validation]" = (),
    *,
    vessel: "Vessel | None" = None,
    previous: "Fingerprint | None" = None,
) -> Cover:
    """Return the first page of a report.

    ``fingerprint``: what was found. ``validations``: the fingerprint's model held against records that it has not seen;
    only the first counts. ``vessel``: what was tested, for the sketch. ``previous``: fingerprint of an earlier test.
    """
    change = [] if previous is None else [change_answer(previous, fingerprint)]
    verdict = fingerprint.verdict
    of_line = [
        *hunting(fingerprint),
        *inertia(fingerprint),
        *propeller(fingerprint),
        *other_contradictions(fingerprint),
        *gauge(fingerprint),
        predicts(validations),
    ]
    # where no number can be used there is one cause and one action: what follows from it is not judged
    judged = of_line if verdict.trustworthy else [not_judged(card) for card in of_line]
    cards = [usable(fingerprint), *change, *judged, measured(fingerprint)]
    partly = bool(verdict.reasons) or is_partial(fingerprint)
    state, headline = overall(cards, usable=verdict.trustworthy, partly=partly)
    company = None if vessel is None else vessel.company
    logo_path = None if company is None else company.logo_path
    logo, missing = (None, "") if logo_path is None else drawn_logo(logo_path)
    return Cover(
        headline=headline,
        state=state,
        opening=OPENING,
        cards=cards,
        known=_known(fingerprint),
        change=f"{change[0].question} {change[0].sentence}" if change else "",
        facts=[*_facts(fingerprint, vessel), *([("Logo", missing)] if missing else [])],
        tables=number_table(fingerprint) if verdict.trustworthy else [],
        sketch=None if vessel is None else line_sketch(vessel),
        company="" if company is None else company.name,
        logo=logo,
    )


def _working_point(fingerprint: "Fingerprint", vessel: "Vessel | None") -> str:
    conditions = fingerprint.conditions
    speed, torque = conditions.engine_speed, conditions.shaft_torque
    found = (
        f"{plain(speed.value, 0)} {unit_text(speed.unit)} engine speed, "
        f"{to_digit_of(torque.value, torque.std)} {unit_text(torque.unit)} shaft torque"
    )
    if not fingerprint.verdict.trustworthy:
        return f"{found}, as recorded; in doubt"
    return f"{found}{_power(fingerprint, vessel)}"


def _power(fingerprint: "Fingerprint", vessel: "Vessel | None") -> str:
    """Return the power that both make at the gauge; nothing where nobody knows the speed of the shaft."""
    if vessel is None:
        return ""
    speed, torque = fingerprint.conditions.engine_speed, fingerprint.conditions.shaft_torque
    shaft_rad_s = 2.0 * math.pi * speed.value / 60.0 / vessel.gearbox.ratio
    # the speed counts turns, and is known far better than the torque
    return f", {with_deviation(shaft_rad_s * torque.value / WATT, shaft_rad_s * torque.std / WATT)} kW"


def _known(fingerprint: "Fingerprint") -> str:
    """Return how many numbers the verdict trusts: the one rule for what is known."""
    verdict = fingerprint.verdict
    known = len(verdict.trusted) if verdict.trustworthy else 0
    count = f"{known} of {len(verdict.trusted) + len(verdict.not_trusted)} numbers are known"
    main = main_in_words(verdict.trusted, verdict.not_trusted) if verdict.trustworthy else ""
    return f"{count}. {main}" if main else count


def _facts(fingerprint: "Fingerprint", vessel: "Vessel | None") -> list[tuple[str, str]]:
    conditions = fingerprint.conditions
    ship = ship_text(conditions.ship)
    return [
        *([("Ship", ship)] if ship else []),
        *([("Tested", tested)] if (tested := tested_text(conditions.tested_at)) else []),
        *([("Place", conditions.place)] if conditions.place else []),
        ("Working point", _working_point(fingerprint, vessel)),
        *water_facts(conditions),
    ]

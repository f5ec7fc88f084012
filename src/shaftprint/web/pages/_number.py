"""An owner gives a ship that has none its IMO number: nobody else does, for rights go with it."""

from dataclasses import replace

from starlette.exceptions import HTTPException

from shaftprint.store._overview import give_imo_number
from shaftprint.web._asked import Asked, Moved, NotThere, line_address
from shaftprint.web.access._person import Role
from shaftprint.web.pages._line import records_of
from shaftprint.web.pages._recordings import is_imo_number


async def give_number(asked: Asked) -> Moved:
    """Give a ship its IMO number; from then on it is seen by whoever was given that."""
    asked.expect(Role.OWNER)
    records = await asked.read(records_of, asked)
    number = asked.fields.get("imo", "").strip().upper().removeprefix("IMO").strip()
    if not is_imo_number(number):
        raise HTTPException(
            400, f"Expected an IMO number, seven digits of which the last checks the others, found {number[:20]!r}."
        )
    ship = records.line.ship
    if ship.imo_number is not None:
        raise HTTPException(409, f"{ship.name} has an IMO number, which it keeps for life.")
    if not asked.person.sees(replace(ship, imo_number=int(number))):
        raise NotThere
    numbered = await asked.read(give_imo_number, asked.service.store, ship, int(number))
    await asked.read(asked.service.kept.give_number, ship.name, int(number))
    line = replace(records.line, ship=numbered)
    asked.note("gave an IMO number", line, name=ship.name)
    asked.service.judging.wake()
    return Moved(to=line_address(line, records.ship_id), data={"name": ship.name, "imo": int(number)}, status=201)

"""``plan.json``: a planned test, to be read again when it goes on."""

from pathlib import Path
from typing import Final

from pydantic import ValidationError

from shaftprint.arguments import refusing_none
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.design.files._plan_record import SCHEMA_VERSION, PlanRecord, record_of
from shaftprint.design.planned_test._planned_test import PlannedTest
from shaftprint.errors import DesignError, ShaftprintError
from shaftprint.files import read_json, write_bytes
from shaftprint.models._structure import Structure
from shaftprint.publication._publish import complete
from shaftprint.records import faults
from shaftprint.spelling import meant_beside

PLAN: Final = "plan.json"
"""Name of the file in a folder of ``shaftprint plan``."""
_MOST_NAMED = 5


def write_plan(test: PlannedTest, path: str | Path) -> None:
    """Write a planned test as JSON, whole or not at all; an existing file is replaced.

    Raises DesignError if the file cannot be written.
    """
    content = (record_of(test).model_dump_json(indent=1) + "\n").encode()
    write_bytes(Path(path), content, noun="plan", error=DesignError)


@refusing_none(DesignError)
def read_plan(path: str | Path, *, structure: Structure | None = None) -> PlannedTest:
    """Read a planned test from its file, or from the folder with it.

    Parameters
    ----------
    path
        The file or the folder.
    structure
        The structure of the plan where it is none of the shipped ones: a name in a file is looked up, never run.

    Raises
    ------
    DesignError
        If the file is missing, is no plan, is of another schema, or has fields that are wrong; all of them are listed.
    """
    json_path = Path(path) / PLAN if Path(path).is_dir() else Path(path)
    complete(json_path.parent)
    content = _content(json_path)
    try:
        record = PlanRecord.model_validate_json(content)
        return record.planned_test(_structure(record, structure))
    except ValidationError as error:
        wrong = faults(error, most=_MOST_NAMED)
        raise DesignError(f"{json_path} is not a plan of schema {SCHEMA_VERSION}: {wrong}.") from None
    except (ValueError, TypeError, KeyError) as error:
        raise DesignError(f"{json_path} is not a plan of schema {SCHEMA_VERSION}: {error}.") from None
    except ShaftprintError as error:
        # what other nouns ask of themselves, such as limits that contradict each other
        raise DesignError(f"{json_path} is not a plan of schema {SCHEMA_VERSION}: {error}") from None


def _structure(record: PlanRecord, own: Structure | None) -> Structure:
    name = record.ship.structure
    if own is None:
        try:
            structure = shipped_structure(name, record.ship.values)
        except ShaftprintError:
            raise DesignError(
                f"structure {name}: it is none of the shipped ones; name the file of your own with --structure."
            ) from None
    elif own.name != name:
        raise DesignError(f"structure: expected {name}, which the plan was made for, found {own.name}.")
    else:
        structure = own
    free = {p.name for p in structure.free}
    held = {name: record.ship.values[name] for name in record.ship.held if name in free}
    # what the sensors of the ship leave open, which the shipped structure holds; old files name nothing that is held
    still = record.ship.held or tuple(p.name for p in structure.parameters if p.held)
    opened = {p.name: (p.lower, p.upper) for p in structure.parameters if p.held and p.name not in still}
    return structure.held_at(**held).free_between(**opened)


def _content(json_path: Path) -> str:
    """Return the content of a file that claims to be a plan of the schema that is known here."""

    def where() -> str:
        return f"name the folder in which shaftprint plan has put it.{meant_beside(json_path)}"

    text, content = read_json(json_path, noun="plan", where=where, error=DesignError)
    schema = content.get("schema_version") if isinstance(content, dict) else None
    if schema != SCHEMA_VERSION:
        raise DesignError(
            f"{json_path}: expected a plan of schema {SCHEMA_VERSION}, found "
            f"{'none' if schema is None else f'schema {schema}'}; read it with the version of shaftprint that wrote it."
        )
    return text

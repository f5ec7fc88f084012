"""Settings files: TOML read into frozen models, with every error of a file in one message.

A settings file carries the unit of every number in its key: ``frequency_hz``, ``inertia_kg_m2``.
"""

import difflib
import re
import tomllib
from collections.abc import Collection, Mapping, Sequence
from importlib.resources import as_file, files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import ErrorDetails

from shaftprint.errors import SettingsError
from shaftprint.file_kinds import kind_of
from shaftprint.files import reason, written_whole
from shaftprint.notebook._shown import field_words
from shaftprint.publication._publish import complete
from shaftprint.spelling import meant, meant_beside

# Larger than anything on a ship in any unit, and small enough that products and squares stay numbers.
_LARGEST = 1e30

Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-_LARGEST, le=_LARGEST)]
PositiveNumber = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0, le=_LARGEST)]
NotNegativeNumber = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0, le=_LARGEST)]
PositiveInteger = Annotated[int, Field(strict=True, gt=0, le=1_000_000)]
Name = Annotated[str, Field(strict=True, min_length=1)]

# The ending of a key that names its unit; matches the longest, as a search finds the leftmost.
_UNIT = re.compile(r"_(rad_s|rev_s|kg_m2|kg_m3|k?hz|mhz|rpm|deg|rad|rev|k?nm|k?w|hp|m?v|ma|[um]?s|min|h|[cm]?m)$")

# A number with a decimal comma, as it stands in a line of its own.
_COMMA = re.compile(r"\s*([\w.\"-]+)\s*=\s*([+-]?\d+),(\d+(?:[eE][+-]?\d+)?)\s*(?:#.*)?$")

# What pydantic expects, in the words of somebody who fills in a file.
_EXPECTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "text in quotes",
    "string_too_short": "text",
    "finite_number": "a finite number",
    "greater_than": "a number greater than {gt:g}",
    "greater_than_equal": "a number not less than {ge:g}",
    "less_than_equal": "a number not greater than {le:g}",
    "tuple_type": "a list in brackets, or [[rows]] in double brackets",
    "model_type": "a [table]",
}


class Settings(BaseModel):
    """Base of every table of a settings file: frozen, and unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    def __dir__(self) -> list[str]:
        """Return the words of the field; pydantic's stay out of what a session completes."""
        return field_words(super().__dir__(), BaseModel)


_Model = TypeVar("_Model", bound=Settings)
_Place: TypeAlias = tuple[int | str, ...]


def names_twice(names: Sequence[str]) -> list[str]:
    """Return the names that stand there more than once, in the order of letters."""
    return sorted({name for name in names if names.count(name) > 1})


def read_settings(path: str | Path, model_class: type[_Model]) -> _Model:
    """Read a TOML file into a model.

    Parameters
    ----------
    path
        The settings file.
    model_class
        What the file describes.

    Raises
    ------
    SettingsError
        If the file cannot be read, is not TOML, or has fields that cannot be used; the message then
        lists all of them, each with its dotted path (rows are counted from 1), what was expected
        and what was found.
    """
    path = Path(path)
    complete(path.parent)
    content = _content(path)
    try:
        return model_class.model_validate(content)
    except ValidationError as error:
        kind, wanted = kind_of(content), kind_of(model_class.model_fields)
        if kind is not None and wanted is not None and kind != wanted:
            # one sentence for one mistake, in place of one for every key of the other kind
            raise SettingsError(
                f"{path}: expected a {wanted} file, found a {kind} file; give the {wanted} file here, and this one "
                f"where a {kind} file is asked for."
            ) from None
        raise SettingsError(_describe_all(path, error, model_class, content)) from None


def _content(path: Path) -> dict[str, Any]:
    """Return what stands in a TOML file, not checked yet."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise SettingsError(
            f"{path}: expected a settings file, found nothing there; shaftprint new writes one to fill in."
            f"{meant_beside(path)}"
        ) from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise SettingsError(
            f"{path}, line {line}: expected text in UTF-8, found the byte {error.object[error.start]:#04x}; save the "
            "file as UTF-8."
        ) from None
    except OSError as error:
        if path.is_dir():
            raise SettingsError(f"{path}: expected a settings file, found a folder; name the file in it.") from None
        raise SettingsError(f"{path}: expected a settings file, but it cannot be read: {reason(error)}.") from None
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        commas = _decimal_commas(text)
        if commas:
            sentences = [f"{path}: expected decimal points, found decimal commas.", *commas]
            raise SettingsError("\n  ".join(sentences)) from None
        # more than a mistake in the text: numbers of thousands of digits, brackets within thousands of brackets
        raise SettingsError(f"{path}: expected TOML, found a mistake: {error}.") from None


def _decimal_commas(text: str) -> list[str]:
    """Return a sentence for each line whose number has a decimal comma."""
    matches = ((number, _COMMA.match(line)) for number, line in enumerate(text.splitlines(), start=1))
    return [f"line {number}: write {m[1]} = {m[2]}.{m[3]} with a point." for number, m in matches if m is not None]


def load_settings(path_or_name: str | Path, model_class: type[_Model], *, shipped: Traversable) -> _Model:
    """Read a settings file, or one of those that come with the package by its name.

    Parameters
    ----------
    path_or_name
        A path, or the name of a shipped file such as ``stan-tug-1205``: text without a folder and
        without the ending ``.toml``.
    model_class
        What the file describes.
    shipped
        The folder of the shipped files.

    Raises
    ------
    SettingsError
        As ``read_settings``; if the name is not that of a shipped file, the message lists the names.
    """
    text = str(path_or_name)
    is_path = isinstance(path_or_name, Path) or text.endswith(".toml") or "/" in text or "\\" in text
    if is_path:
        return read_settings(path_or_name, model_class)
    with as_file(_shipped_file(text, shipped)) as path:
        return read_settings(path, model_class)


def settings_content(path_or_name: str | Path, *, shipped: Traversable) -> bytes:
    """Return the bytes of a settings file that has been loaded before, from a path or by the name of a shipped one."""
    if str(path_or_name) in shipped_names(shipped):
        return _shipped_file(str(path_or_name), shipped).read_bytes()
    return Path(path_or_name).read_bytes()


def _shipped_file(name: str, shipped: Traversable) -> Traversable:
    """Return a file that comes with the package."""
    names = shipped_names(shipped)
    if name not in names:
        own = [f"{name}.toml"] if Path(f"{name}.toml").is_file() else []
        raise SettingsError(
            f'"{name}": expected a path that ends in .toml or one of the shipped names {", ".join(names)}.'
            f"{meant(name, own or names)}"
        )
    return shipped / f"{name.replace('-', '_')}.toml"


def shipped_names(shipped: Traversable) -> tuple[str, ...]:
    """Return the names of the settings files in a folder of the package, sorted."""
    names = (entry.name for entry in shipped.iterdir() if entry.name.endswith(".toml"))
    return tuple(sorted(name.removesuffix(".toml").replace("_", "-") for name in names))


def write_template(
    kind: Literal["vessel", "campaign", "conditions", "drive"], path: str | Path, *, shipped: str | None = None
) -> None:
    """Write a commented settings file that can be loaded as it stands, to be filled in or changed.

    Parameters
    ----------
    kind
        What to describe.
    path
        A file that does not exist yet.
    shipped
        Name of the shipped file to begin with; the template when not given.

    Raises
    ------
    SettingsError
        If there is no shipped file of that name, the file exists already or cannot be written; nothing is left
        half-written.
    """
    folder = files("shaftprint") / ("campaign" if kind == "conditions" else kind)
    source = folder / ("conditions.toml" if kind == "conditions" else "template.toml")
    if shipped is not None:
        source = _shipped_file(shipped, folder / "shipped")
    text = source.read_text(encoding="utf-8")
    try:
        with written_whole(Path(path)) as part:
            part.write_text(text, encoding="utf-8")
    except FileExistsError as error:
        raise SettingsError(str(error)) from None
    except OSError as error:
        raise SettingsError(f"{path}: the file cannot be written: {reason(error)}.") from None


def _describe_all(path: Path, error: ValidationError, model_class: type[Settings], content: Mapping[str, Any]) -> str:
    faults = error.errors()
    missing = {fault["loc"] for fault in faults if fault["type"] == "missing"}
    unknown = [fault["loc"] for fault in faults if fault["type"] == "extra_forbidden"]
    # a missing key that stands there under another name is told once, at that name
    elsewhere = missing & {(*place[:-1], _key_meant(place, model_class, missing)) for place in unknown}
    # entries that cannot be used are not counted: that too few are left is no fault of its own
    filled = {fault["loc"][:depth] for fault in faults for depth in range(1, len(fault["loc"]))}
    told = [fault for fault in faults if fault["type"] != "too_short" or fault["loc"] not in filled]
    rows = [_describe(fault, model_class, content, missing) for fault in told if fault["loc"] not in elsewhere]
    count = "1 field" if len(rows) == 1 else f"{len(rows)} fields"
    return "\n  ".join([f"{path}: {count} cannot be used.", *rows])


def _describe(details: ErrorDetails, model_class: type[Settings], content: Any, missing: Collection[_Place]) -> str:
    where = _dotted_path(details["loc"], content)
    match details["type"]:
        case "missing":
            return f"{where}: expected a value, found none; add the key."
        case "extra_forbidden":
            return f"{where}: expected no such key; {_advice(details['loc'], model_class, missing)}"
        case "value_error":
            return f"{where}: {details['msg'].removeprefix('Value error, ')}"
        case "too_short":
            limits = details["ctx"]
            return f"{where}: expected at least {limits['min_length']} entries, found {limits['actual_length']}."
        case kind if kind in _EXPECTED:
            expected = _EXPECTED[kind].format_map(details.get("ctx", {}))
            return f"{where}: expected {expected}, found {details['input']!r}."
        case _:
            expected = details["msg"].removeprefix("Input should be ")
            return f"{where}: expected {expected}, found {details['input']!r}."


def _dotted_path(location: Sequence[int | str], content: Any) -> str:
    """Write a location as ``sines[4].frequency_hz (S4)``, rows counted from 1, with the row's name."""
    text, name = "", ""
    for step in location:
        text += f"[{step + 1}]" if isinstance(step, int) else f".{step}"
        try:
            content = content[step]
        except (KeyError, IndexError, TypeError):
            content = None
        if isinstance(step, int) and isinstance(content, Mapping) and "name" in content:
            name = f" ({content['name']})"
    return (text.removeprefix(".") or "the file") + name


def _known_keys(model_class: type[Settings], location: Sequence[int | str]) -> tuple[str, ...]:
    """Return the keys of the table at a location, following fields and rows of the model."""
    table: type[Settings] = model_class
    for step in location:
        if isinstance(step, str):
            table = _model_within(table.model_fields[step].annotation)
    return tuple(table.model_fields)


def _model_within(annotation: Any) -> type[Settings]:
    """Find the model in an annotation such as ``tuple[Sine, ...]`` or ``Logger | None``."""
    if isinstance(annotation, type) and issubclass(annotation, Settings):
        return annotation
    # the model comes first in every annotation that holds one
    return _model_within(get_args(annotation)[0])


def _advice(place: _Place, model_class: type[Settings], missing: Collection[_Place]) -> str:
    key, meant_key = str(place[-1]), _key_meant(place, model_class, missing)
    if not meant_key:
        return f"the known keys are {', '.join(_known_keys(model_class, place[:-1]))}."
    if _without_unit(meant_key) != _without_unit(key):
        return f"is {meant_key} meant?"
    hertz = key.endswith("_rad_s") and meant_key.endswith("_hz")
    return f"the value is wanted as {meant_key}: {'divide it by 2 pi' if hertz else 'convert it to that unit'}."


def _key_meant(place: _Place, model_class: type[Settings], missing: Collection[_Place]) -> str:
    """Return what an unknown key stands for: what is missing rather than what is there; empty where nothing is like it.

    A key without its unit, or with another one, goes before letters that are alike.
    """
    *table, key = place
    keys = sorted(_known_keys(model_class, table), key=lambda known: (*table, known) not in missing)
    of_other_unit = [known for known in keys if _without_unit(known) == _without_unit(str(key))]
    return next(iter(of_other_unit or difflib.get_close_matches(str(key), keys, n=1)), "")


def _without_unit(key: str) -> str:
    return _UNIT.sub("", key)

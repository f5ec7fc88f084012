"""A campaign as the text of its file, which ``load_campaign`` reads back equal."""

from collections.abc import Mapping

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import SPEED_SET_POINT
from shaftprint.escape import toml_string

TESTS = ("staircases", "sines", "multisines", "binary_sequences", "chirps")
"""Lists of tests, in the order in which a file has them."""

# Fields that few tests need: they stand in a file where they say something.
_SELDOM: Mapping[str, object] = {"phase_rad": 0.0, "first_clock": 0}
# a multisine moves something else than the speed in few tests
_SELDOM_OF: Mapping[str, Mapping[str, object]] = {"multisines": {**_SELDOM, "input": SPEED_SET_POINT}}
# Digits behind the point: a period of half a minute is then right to the last sample of a day.
_DIGITS = 12


def campaign_text(campaign: Campaign, *, remarks: str = "") -> str:
    """Return a campaign as the text of a TOML file.

    ``remarks``: what is said at the head of the file, as comments, a line each.
    """
    values = campaign.model_dump(exclude_none=True, exclude={*TESTS, "further_offsets_v"})
    # a control character would end the comment and begin a setting
    head = [f"# {toml_string(line)[1:-1]}" for line in remarks.splitlines()]
    lines = [f"{key} = {_value(value)}" for key, value in values.items()]
    if campaign.further_offsets_v:
        lines += ["", "[further_offsets_v]"]
        lines += [f"{toml_string(name)} = {_value(volts)}" for name, volts in campaign.further_offsets_v.items()]
    return "\n".join([*head, *([""] if head else []), *lines, "", tests_text(campaign)])


def tests_text(campaign: Campaign) -> str:
    """Return the tests of a campaign as the lines of a campaign file."""
    parts = []
    for section in TESTS:
        for test in getattr(campaign, section):
            fields, seldom = test.model_dump(exclude_none=True).items(), _SELDOM_OF.get(section, _SELDOM)
            lines = [f"{key} = {_value(value)}" for key, value in fields if seldom.get(key) != value]
            parts.append("\n".join([f"[[{section}]]", *lines]))
    return "\n\n".join(parts) + "\n"


def _value(value: object) -> str:
    match value:
        case str():
            return toml_string(value)
        case bool():
            return str(value).lower()
        case int():
            return str(value)
        case float():
            # a float of TOML has a point
            return repr(round(value, _DIGITS))
        case tuple() | list():
            return f"[{', '.join(_value(item) for item in value)}]"
        case Mapping():
            return f"{{ {', '.join(f'{toml_string(str(key))} = {_value(item)}' for key, item in value.items())} }}"
        case _:
            raise TypeError(f"campaign file: expected text, numbers and lists, found {type(value).__name__}.")

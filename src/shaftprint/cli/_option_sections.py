"""Commands with many options, whose help has them under what they are for, below an example."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import click

from shaftprint.cli._missing_files import missing_words, swapped_words

WIDEST_COLUMN = 30
"""Letters that the names of options have beside their help."""


_WITH_COMMA = re.compile(r"(-?\d+),(\d+)")
_COMMA = re.compile(r"^'(-?\d+,\d+)' is not a valid")


def comma_words(text: str) -> str:
    """Return what to do about a number with a comma; empty where a text is none."""
    found = _WITH_COMMA.fullmatch(text.strip())
    if found is None:
        return ""
    whole, behind = found.groups()
    return (
        f"'{whole},{behind}' has a comma: write {whole}.{behind} with a decimal point, or {whole}{behind} if it stands "
        "between thousands."
    )


class MissingParameters(click.MissingParameter):
    """All that a command lacks, in words of their own."""

    def format_message(self) -> str:
        """Return the words alone."""
        return self.message


class SectionedCommand(click.Command):
    """A command whose help begins with an example, and names what is needed first."""

    def __init__(self, *args: Any, example: str, sections: Mapping[str, Sequence[str]], **attributes: Any) -> None:
        """Take what ``click.Command`` takes, an example and the longest name of each option by what it is for.

        ``sections``: in the order of the help; options that none of them names stand last, under Output.
        """
        super().__init__(*args, **attributes)
        self.example, self.sections = example, sections

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the options; what is missing is said at once, and that numbers have a decimal point."""
        typed = list(args)
        try:
            rest = super().parse_args(ctx, args)
        except click.MissingParameter:
            words = missing_words(self, ctx, typed)
            if not words:
                raise
            raise MissingParameters(words, ctx) from None
        except click.BadParameter as error:
            found = _COMMA.search(error.message)
            if found is None:
                raise
            raise click.BadParameter(comma_words(found[1]), ctx, error.param) from None
        swapped = swapped_words(self, ctx)
        if swapped:
            raise click.UsageError(swapped, ctx)
        return rest

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write what the command does, and how it is called."""
        super().format_help_text(ctx, formatter)
        with formatter.section("Example"):
            for line in self.example.splitlines():
                formatter.write(f"{'':{formatter.current_indent}}{line}\n")

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options by what they are for, in columns that all of them share."""
        shown = {
            max(parameter.opts, key=len): record
            for parameter in self.get_params(ctx)
            if isinstance(parameter, click.Option) and (record := parameter.get_help_record(ctx)) is not None
        }
        # longer ones stand on a line of their own
        longest = min(max(len(words) for words, _ in shown.values()), WIDEST_COLUMN)
        by_heading = {heading: [shown.pop(name) for name in names] for heading, names in self.sections.items()}
        for heading, records in {**by_heading, "Output": [*shown.values()]}.items():
            with formatter.section(heading):
                formatter.write_dl([(words.ljust(longest), text) for words, text in records], col_max=WIDEST_COLUMN)

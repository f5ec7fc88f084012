"""A group of commands that are imported only when they are called."""

import importlib
from collections.abc import Mapping

import click


class LazyGroup(click.Group):
    """Commands by name, each in a file of its own; asking for their names or one-line helps imports none."""

    helps: Mapping[str, str]
    """The one-line help of every command, in the order of use."""
    prefix: str = ""
    """What stands before a command's name in the name of its file."""
    heading: str = "Commands"
    """What the list of commands is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order of use."""
        return list(self.helps)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is none of that name."""
        if cmd_name not in self.helps:
            return None
        module = importlib.import_module(f"shaftprint.cli._{self.prefix}{cmd_name.replace('-', '_')}")
        command: click.Command = module.command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands with their help without importing them."""
        with formatter.section(self.heading):
            formatter.write_dl(list(self.helps.items()))

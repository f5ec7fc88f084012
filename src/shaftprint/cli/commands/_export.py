"""``shaftprint export``: the identified model in the user's tool."""

import importlib
from collections.abc import Mapping
from typing import ClassVar

import click

from shaftprint.cli._command_group import LazyGroup
from shaftprint.cli._speech import speaking

# The one-line help of every format; asking its file for it would import what only that format needs.
FORMATS = {
    "fmu": "Write an FMU (FMI 2.0 or 3.0) for Simulink, Open Simulation Platform and others.",
    "osp": "Describe the variable groups of the FMU to Open Simulation Platform.",
    "ssp": "Write the parameters as an SSP parameter set (.ssv).",
    "modelica": "Write a Modelica package with limits and exact delays.",
    "matlab": "Write a .mat file and a function for MATLAB and Octave that rebuilds the objects.",
    "csv": "Write tables of parameters, combinations and the frequency response with its band.",
    "json": "Write parameters, state space and frequency response as one JSON file.",
}


class FormatGroup(LazyGroup):
    """The formats by name."""

    sections: ClassVar[Mapping[str, Mapping[str, str]]] = {"Formats": FORMATS}
    folder = "shaftprint.cli.commands.formats"

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a format: a row of the table, or a file of its own where it has options of its own."""
        if cmd_name not in self.helps or cmd_name in ("fmu", "matlab"):
            return super().get_command(ctx, cmd_name)
        table = importlib.import_module(f"{self.folder}._table")
        return speaking(table.format_command(cmd_name))


@click.group("export", cls=FormatGroup, subcommand_metavar="FORMAT [ARGS]...")
def command() -> None:
    """Write the model of a fingerprint for another program.

    Each format has options of its own: `shaftprint export fmu --help`.
    """

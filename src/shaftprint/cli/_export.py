"""``shaftprint export``: the identified model in the user's tool, one format a file beside this one."""

import importlib

import click

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


class FormatGroup(click.Group):
    """The formats by name, imported only when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names."""
        return list(FORMATS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a format; None if there is none of that name."""
        if cmd_name not in FORMATS:
            return None
        module = importlib.import_module(f"shaftprint.cli._export_{cmd_name.replace('-', '_')}")
        command: click.Command = module.command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the formats with their help without importing them."""
        with formatter.section("Formats"):
            formatter.write_dl(list(FORMATS.items()))


@click.group("export", cls=FormatGroup, subcommand_metavar="FORMAT [ARGS]...")
def command() -> None:
    """Write the model of a fingerprint for another program.

    Each format has options of its own: `shaftprint export fmu --help`.
    """

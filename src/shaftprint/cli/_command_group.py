"""The commands of the program, and how they end."""

import errno
import importlib
import re
from collections.abc import Mapping
from typing import Any, ClassVar, NoReturn

import click

from shaftprint.cli._speech import speaking
from shaftprint.cli._terminal import echo, print_document
from shaftprint.errors import ShaftprintError
from shaftprint.escape import terminal_message
from shaftprint.spelling import meant

# The one-line help of every command, in the order of use. It stands here, and not in the commands only, because
# asking every command for it would import them all: 0.26 s instead of 0.07. A test holds both against each other.
SECTIONS = {
    "Begin": {
        "start": "Say what lies in a folder and what comes next; ask for the ship's main particulars first.",
        "demo": "Simulate the Stan Tug 1205 and identify it from its recording.",
    },
    "Plan a test": {
        "new": "Write a commented vessel, campaign, conditions or drive file to fill in.",
        "predict": "Predict the accuracy of a planned test.",
        "sensitivity": "Draw the effect of each parameter of a structure on its response.",
        "inertia": "Calculate inertia and torsional modes from the vessel file.",
        "plan": "Plan the strongest test within a time, or the shortest that meets your wishes.",
        "continue": "Say what is known so far of a planned test, and plan what is still missing.",
        "sail": "Simulate the test of a ship and write the raw recording of its logger.",
    },
    "Make a test": {
        "live": "Play a test through a device on board, the counterpart; watch it, judge it and stop it.",
    },
    "Prepare a recording": {
        "inspect": "Show what is in a recording and whether it is good enough.",
        "merge": "Bring the recordings of two loggers onto the clock of the first.",
        "join": "Join files that one logger wrote one after the other, in the order given.",
        "convert": "Write recordings of any readable format as NetCDF or in another format.",
    },
    "Identify": {
        "identify": "Identify the fingerprint from a recording.",
        "service": "Identify a line from the logs of its ordinary service, without a test.",
        "limits": "Find which limits a line has, and their levels and rates with uncertainty.",
        "structures": "List the model structures with their parameters, meanings and bounds.",
    },
    "Judge": {
        "show": "Print a saved fingerprint.",
        "compare": "Compare fingerprints: what differs, and whether by more than chance.",
        "drift": "Watch a line over the years: what has changed, since when, and how fast.",
        "sisters": "Compare the ships of a class: which one differs, and in what.",
        "validate": "Validate a model on chirps and steps that it was not identified from.",
        "compare-structures": "Compare model structures on a recording: which explains it best, and why.",
        "explain": "Explain the numbers of the thesis' method on one recording.",
    },
    "Use the model": {
        "simulate": "Simulate speed and torque for a set point, with limits where the model has them.",
        "export": "Write the model of a fingerprint for another program.",
    },
    "Keep over the years": {
        "store": "Keep the fingerprints of many ships, with their history.",
        "serve": "Serve pages of the store: how each ship stands, histories, comparisons, uploads and jobs.",
        "fleet": "Identify many recordings, and keep their fingerprints in a store.",
        "work": "Do the jobs of a store on this computer.",
    },
}

NOT_REACHED = 3
"""Exit code of a command that has done its work, and whose answer is that what was asked for cannot be had."""
CHANGED = 4
"""Exit code of a command that was asked to say so, and has found that a ship has changed."""
INTERRUPTED = 130
_ARGUMENT = re.compile(r"\b[a-z_]+= \((--[a-z-]+(?: (?:\"[^\"]*\"|[^()\"])*)?(?:, [^()]*)?)\)")


class LazyGroup(click.Group):
    """Commands by name, each in a file of its own; asking for their names or one-line helps imports none."""

    sections: ClassVar[Mapping[str, Mapping[str, str]]]
    """The one-line help of every command, in the order of use, by what they are for."""
    folder: ClassVar[str]
    """The package that holds the file of each command."""

    @property
    def helps(self) -> Mapping[str, str]:
        """The one-line help of every command, in the order of use."""
        return {name: line for commands in self.sections.values() for name, line in commands.items()}

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order of use."""
        return list(self.helps)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is none of that name."""
        if cmd_name not in self.helps:
            return None
        module = importlib.import_module(f"{self.folder}._{cmd_name.replace('-', '_')}")
        command: click.Command = module.command
        return command if isinstance(command, click.Group) else speaking(command)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; of one that does not exist, say which was probably meant."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            advice = meant(args[0], self.helps) or f" The commands are {', '.join(self.helps)}."
            raise click.UsageError(f"{error.message}{advice}", ctx) from None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands with their help by what they are for, without importing them."""
        longest = max(map(len, self.helps))
        for heading, commands in self.sections.items():
            with formatter.section(heading):
                formatter.write_dl([(name.ljust(longest), line) for name, line in commands.items()])


def actions_of(package: str, helps: Mapping[str, str]) -> type[LazyGroup]:
    """Return the group of the actions of a command.

    ``package``: the package that holds the file of each. ``helps``: the one-line help of each, in the order of use.
    """

    class ActionGroup(LazyGroup):
        sections: ClassVar[Mapping[str, Mapping[str, str]]] = {"Actions": helps}
        folder = package

    return ActionGroup


class CommandGroup(LazyGroup):
    """The commands by name, with one place that turns errors into a sentence and an exit code."""

    sections = SECTIONS
    folder = "shaftprint.cli.commands"

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; what the user can mend ends in one sentence and a non-zero exit code.

        Raises click.ClickException for an error that the user can mend; click prints it and exits with 1.
        """
        try:
            return self._invoked(ctx)
        except ShaftprintError as error:
            raise click.ClickException(terminal_message(options_for_arguments(str(error)))) from error
        except click.ClickException as error:
            # click says of its own attribute that nobody is to change it
            vars(error)["message"] = terminal_message(f"{error.message}{_advice(error)}")
            raise
        except KeyboardInterrupt:
            echo("Interrupted; nothing is left half-written.", err=True)
            ctx.exit(INTERRUPTED)
        except OSError as error:
            if error.errno == errno.EPIPE:
                raise
            raise click.ClickException(terminal_message(_describe(error))) from error

    def _invoked(self, ctx: click.Context) -> Any:
        """Run a command and give what it gathered, where its answer is a no as well."""
        try:
            returned = super().invoke(ctx)
        except click.exceptions.Exit as end:
            if end.exit_code in (NOT_REACHED, CHANGED):
                print_document()
            raise
        print_document()
        return returned


def end_with_no() -> NoReturn:
    """End a command that has done its work, and whose answer is no."""
    click.get_current_context().exit(NOT_REACHED)


def _advice(error: click.ClickException) -> str:
    """Return what to do where a second recording was named."""
    context = error.ctx if isinstance(error, click.UsageError) else None
    named = () if context is None else tuple(one.name for one in context.command.params)
    if "recording" not in named or "unexpected extra argument" not in error.message:
        return ""
    return (
        ": it takes one recording. `shaftprint join` puts together what one logger wrote one after the other, "
        "`shaftprint merge` what two loggers recorded at once."
    )


def options_for_arguments(sentence: str) -> str:
    """Return a sentence of the library as the command line says it: ``--dbc`` in place of ``dbc= (--dbc)``."""
    return _ARGUMENT.sub(r"\1", sentence)


def _describe(error: OSError) -> str:
    prefix = f"{error.filename}: " if error.filename is not None else ""
    return f"{prefix}{error.strerror or error}; check the path, the permissions and the free space."

"""``shaftprint fleet``: many recordings to fingerprints in a store, one file an action."""

from collections.abc import Mapping
from typing import ClassVar

import click

from shaftprint.cli._command_group import LazyGroup

# The one-line help of every action: a list of them imports none of their files.
ACTIONS = {
    "run": "Identify the recordings of a folder or a list, and keep their fingerprints.",
    "status": "Show how many jobs wait, run, are done or were refused, and why.",
    "retry": "Let refused jobs wait again: those with some numbers, or all.",
    "report": "Write the report of one job, as identify does.",
}


class ActionGroup(LazyGroup):
    """The actions by name."""

    sections: ClassVar[Mapping[str, Mapping[str, str]]] = {"Actions": ACTIONS}
    folder = "shaftprint.cli.commands.fleet"


@click.group("fleet", cls=ActionGroup, subcommand_metavar="ACTION [ARGS]...")
def command() -> None:
    """Identify many recordings, and keep their fingerprints in a store.

    Which recordings are to be done, and what has become of each, stands in the store. So a run that was ended goes on
    where it was, and several computers may work on it: `shaftprint work`. Begin with `shaftprint store init`.
    """

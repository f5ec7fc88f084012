"""``shaftprint fleet``: many recordings to fingerprints in a store, one file an action."""

import click

from shaftprint.cli._command_group import actions_of

# The one-line help of every action: a list of them imports none of their files.
ACTIONS = {
    "run": "Identify the recordings of a folder or a list, and keep their fingerprints.",
    "status": "Show how many jobs wait, run, are done or were refused, and why.",
    "retry": "Let refused jobs wait again: those with some numbers, or all.",
    "report": "Write the report of one job, as identify does.",
}


@click.group("fleet", cls=actions_of("shaftprint.cli.commands.fleet", ACTIONS), subcommand_metavar="ACTION [ARGS]...")
def command() -> None:
    """Identify many recordings, and keep their fingerprints in a store.

    Which recordings are to be done, and what has become of each, stands in the store. So a run that was ended goes on
    where it was, and several computers may work on it: `shaftprint work`. Begin with `shaftprint store init`.
    """

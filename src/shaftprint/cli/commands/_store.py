"""``shaftprint store``: fingerprints of many ships over years, one file an action."""

import click

from shaftprint.cli._command_group import actions_of

# The one-line help of every action: a list of them imports none of their files.
ACTIONS = {
    "init": "Make an empty store.",
    "add": "Put fingerprints into the store.",
    "list": "List the shaft lines with their newest test.",
    "history": "Show the tests of a ship in the order of time.",
    "event": "Note what was done to a shaft line, such as a docking.",
    "export": "Write all records into one file: a backup, or the way to another database.",
    "import": "Put the records of an export into the store.",
    "check": "Check that every record is as it was written.",
    "upgrade": "Bring a store of an earlier version up to date.",
}


@click.group("store", cls=actions_of("shaftprint.cli.commands.store", ACTIONS), subcommand_metavar="ACTION [ARGS]...")
def command() -> None:
    """Keep the fingerprints of many ships, with their history.

    A store is a file of SQLite on this computer, shaftprint.db by default, or a database of PostgreSQL for several
    computers: --store names it, or the variable SHAFTPRINT_STORE. Begin with `shaftprint store init`.
    """

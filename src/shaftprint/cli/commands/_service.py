"""``shaftprint service``: a fingerprint from ordinary service, one file an action."""

import click

from shaftprint.cli._command_group import actions_of

# The one-line help of every action: a list of them imports none of their files.
ACTIONS = {
    "scan": "Find the moves of the lever in logs, and say what they would tell.",
    "fit": "Identify the fingerprint from the moves that a scan has found.",
    "watch": "Say whether the line changes from day to day.",
}


@click.group(
    "service", cls=actions_of("shaftprint.cli.commands.service", ACTIONS), subcommand_metavar="ACTION [ARGS]..."
)
def command() -> None:
    """Identify a line from the logs of its ordinary service, without a test.

    Needed are lever, engine speed and shaft torque, logged by one logger 20 times a second or more often, every value
    kept. Begin with `shaftprint service scan`.
    """

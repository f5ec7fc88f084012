"""``shaftprint live``: a test that the program plays, watches, judges and stops, one file an action."""

import click

from shaftprint.cli._command_group import actions_of

# The one-line help of every action: a list of them imports none of their files.
ACTIONS = {
    "channels": "Show what a list of data channels (ISO 19848) offers, and what is wrong in it.",
    "check": "Prove that a campaign stays within the envelope of a ship; nothing is played.",
    "rehearse": "Play a test on a simulated ship, as fast as it can be calculated or by the clock.",
    "play": "Play a test through a counterpart on board.",
    "replay": "Judge a recording as if it came in now.",
}


@click.group("live", cls=actions_of("shaftprint.cli.commands.live", ACTIONS), subcommand_metavar="ACTION [ARGS]...")
def command() -> None:
    """Play a test through a device on board, the counterpart; watch it, judge it and stop it.

    The program never replaces the lever: the counterpart goes back to it by itself when the program is gone, and
    nothing is armed before that was seen. Begin with `shaftprint live check`, then `shaftprint live rehearse`.
    """

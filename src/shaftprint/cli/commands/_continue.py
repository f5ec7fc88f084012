"""``shaftprint continue``: what is known so far of a planned test, and what is still missing."""

import click


@click.command("continue")
def command() -> None:
    """Say what is known so far of a planned test, and plan what is still missing."""

"""What the fleet of the demo says, with what was done to it beside."""

from __future__ import annotations

from pathlib import Path

from shaftprint.cli._fleet_demo import CLASS, FOULING_PER_YEAR, INJECTION_PER_YEAR, PROPORTIONAL, RETUNED, WORN
from shaftprint.cli._terminal import answer, echo, say
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.drift._class_numbers import sister_of
    from shaftprint.drift._history import history_of
    from shaftprint.drift._sister_words import sister_sentences
    from shaftprint.drift._sisters import judge_sisters
    from shaftprint.drift._watch import watch
    from shaftprint.drift._words import watch_sentences
    from shaftprint.store._class_histories import class_histories
    from shaftprint.store._store import Store


SEED = 1
PERCENT = 100.0


def print_answers(store: Store) -> None:
    """Print what ``drift`` says of the two ships to which something happened, and ``sisters`` of the class."""
    histories = {one.line.ship.name: history_of(one.fingerprints, one.events) for one in class_histories(store, CLASS)}
    truths = {
        RETUNED: f"its proportional gain was set {PERCENT * (1.0 - PROPORTIONAL):g} % lower, which nobody noted",
        WORN: f"its injection lost {PERCENT * INJECTION_PER_YEAR:g} % a year",
    }
    for name, truth in truths.items():
        found = watch(histories[name], rng=np.random.default_rng(SEED))
        answer(f"{name}: has the ship changed? {' '.join(watch_sentences(found, histories[name]))}")
        say(f"True: {truth}; the propeller of every ship fouls by {PERCENT * FOULING_PER_YEAR:g} % a year.\n")
    ships = [sister_of(name, history) for name, history in histories.items() if history.tests]
    answer(f"Is a ship other than its sisters? {' '.join(sister_sentences(judge_sisters(ships)))}")
    say(f"True: {RETUNED} and {WORN}.\n")


def print_commands(file: Path) -> None:
    """Print the commands that go on from here."""
    for words in (
        f"list --store {file}",
        f"history {WORN} --number K_Q --store {file}",
    ):
        echo(f"shaftprint store {words}")
    echo(f"shaftprint drift {WORN} --store {file} -o drift")
    echo(f'shaftprint sisters "{CLASS}" --store {file} -o sisters')
    echo(f"shaftprint serve --store {file}")

"""Row 8: how long the command line takes to say what it can do."""

from benchmarks.timing import Spread, print_table, run_process
from shaftprint.cli._command_group import SECTIONS


def run(repetitions: int) -> None:
    """Measure row 8 and print it."""
    print("\n## Row 8: shaftprint --help")
    pairs = [(run_process("-c", "import numpy"), run_process("-m", "shaftprint", "--help")) for _ in range(repetitions)]
    rows = []
    for i, label in enumerate(("python -c 'import numpy'", "shaftprint --help")):
        wall, cpu = Spread(tuple(p[i].wall_s for p in pairs)), Spread(tuple(p[i].cpu_s for p in pairs))
        rows.append((label, wall.text(1e3, 0), cpu.text(1e3, 0)))
    wall = Spread(tuple(p[1].wall_s / p[0].wall_s for p in pairs))
    cpu = Spread(tuple(p[1].cpu_s / p[0].cpu_s for p in pairs))
    rows.append(("**ours over numpy's**", wall.text(), cpu.text()))
    print_table(f"Whole processes, {repetitions} pairs in turn", ("what", "wall, ms", "CPU, ms"), rows)
    _of_commands()


def _of_commands() -> None:
    """Print what the help of each command takes: its options, and none of the rooms behind them."""
    names = [name for commands in SECTIONS.values() for name in commands]
    measured = [(name, run_process("-m", "shaftprint", name, "--help")) for name in names]
    rows = [(name, f"{1e3 * one.wall_s:.0f}", f"{1e3 * one.cpu_s:.0f}") for name, one in measured]
    print_table("shaftprint COMMAND --help, one process each", ("command", "wall, ms", "CPU, ms"), rows)

"""Row 13: for how long a user waits, command by command, each in a process of its own."""

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.timing import Run, Spread, print_table, run_process


def run(repetitions: int) -> None:
    """Measure row 13 and print it; the demo makes the recordings that the other commands are given."""
    print("\n## Row 13: for how long a user waits")
    with TemporaryDirectory() as scratch:
        long, short = Path(scratch) / "demo", Path(scratch) / "short"
        # compiles what is not compiled yet, and writes the recording of 14 minutes
        _shaftprint("demo", "--short", "-o", str(short))
        demos = [_shaftprint("demo", "-o", str(long), "--force") for _ in range(repetitions)]
        rows = [_row("demo", demos)]
        work = {
            "inspect, 3.2 h": ("inspect", *_test(long)),
            "identify, 3.2 h": ("identify", *_test(long), "-o", str(Path(scratch) / "result"), "--force"),
            "limits, 14 min": ("limits", *_test(short)),
        }
        for label, words in work.items():
            rows.append(_row(label, [_shaftprint(*words) for _ in range(repetitions)]))
        if find_spec("ziglang") is not None:
            rows.append(_row("export fmu, five platforms", _exports(long, Path(scratch), repetitions)))
    header = ("what", "wall, s", "CPU to the first line, s", "CPU, s", "peak memory, MB")
    print_table(f"Whole processes, {repetitions} of each", header, rows)


def _shaftprint(*words: str) -> Run:
    return run_process("-m", "shaftprint", *words, "--no-progress")


def _test(folder: Path) -> tuple[str, ...]:
    """Return recording, vessel and campaign that a demo left in its folder, as a command takes them."""
    vessel, campaign = str(folder / "vessel.toml"), str(folder / "campaign.toml")
    return (str(folder / "recording.nc"), "--vessel", vessel, "--campaign", campaign)


def _exports(folder: Path, scratch: Path, repetitions: int) -> list[Run]:
    words = ("export", "fmu", str(folder), "--platform", "all", "-o", str(scratch / "line.fmu"), "--force")
    return [_shaftprint(*words) for _ in range(repetitions)]


def _row(label: str, runs: list[Run]) -> tuple[str, ...]:
    def spread(of: Callable[[Run], float]) -> str:
        return Spread(tuple(map(of, runs))).text(digits=1)

    peak = max(run.peak_mb for run in runs)
    times = (spread(lambda r: r.wall_s), spread(lambda r: r.first_line_cpu_s), spread(lambda r: r.cpu_s))
    return (label, *times, f"{peak:.0f}")

"""Row 2: the whole raw recording of the thesis' test to signals, whole processes."""

from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.timing import Run, Spread, print_table, run_process
from shaftprint.campaign import load_campaign
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

# Neither divides the other, nor the length of the recording.
CHUNKS_S = ("131.072", "7.3")


def run(repetitions: int) -> None:
    """Measure row 2 and print it."""
    print("\n## Row 2: raw recording of 11,450 s x 2000 Hz x 5 channels to signals")
    with TemporaryDirectory() as folder:
        path = Path(folder) / "thesis.h5"
        sail(load_vessel("stan-tug-1205"), load_campaign("thesis"), path, seed=1)
        digests = {run_process("-m", "benchmarks.prepare_script", str(path), chunk).output for chunk in CHUNKS_S}
        pairs = [
            [run_process("-m", f"benchmarks.{who}", str(path)) for who in ("naive_script", "prepare_script")]
            for _ in range(repetitions)
        ]
        size_mb = path.stat().st_size / 1e6
    _print_pairs(pairs)
    print(f"\nThe file has {size_mb:.0f} MB (int16, compressed). Chunks of {' and '.join(CHUNKS_S)} s give ", end="")
    print("the same bits." if len(digests) == 1 else "DIFFERENT BITS.")


def _print_pairs(pairs: list[list[Run]]) -> None:
    rows = []
    for i, label in enumerate(("pandas + SciPy, in memory", "shaftprint, prepare_signals")):
        wall, cpu = Spread(tuple(p[i].wall_s for p in pairs)), Spread(tuple(p[i].cpu_s for p in pairs))
        rows.append((label, wall.text(digits=1), cpu.text(digits=1), f"{max(p[i].peak_mb for p in pairs):.0f}"))
    wall = Spread(tuple(p[0].wall_s / p[1].wall_s for p in pairs))
    cpu = Spread(tuple(p[0].cpu_s / p[1].cpu_s for p in pairs))
    memory = max(p[0].peak_mb for p in pairs) / max(p[1].peak_mb for p in pairs)
    rows.append(("**ratio**", wall.text(digits=1), cpu.text(digits=1), f"{memory:.1f}"))
    header = ("what", "wall with imports, s", "CPU, s", "peak memory, MB")
    print_table(f"Whole processes, {len(pairs)} pairs in turn", header, rows)

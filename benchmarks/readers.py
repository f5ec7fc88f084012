"""Row 12: recordings of over 1 GB of other loggers, inspected, converted and prepared, in processes of their own."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.timing import Run, Spread, print_table, run_process
from shaftprint.campaign import load_campaign
from shaftprint.recording import Channel, read_recording
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._tdms import write_tdms
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

# The five channels of the thesis' campaign have 22.9 million samples each: 0.23 GB of counts. As many more channels of
# noise as make 1 GB; nobody reads them but inspect and convert.
MORE_CHANNELS = 20
FORMATS = {"MDF4": (".mf4", write_mdf4), "TDMS": (".tdms", write_tdms)}
WORK = {
    "inspect": ("-m", "shaftprint", "inspect", "{path}", "--no-progress"),
    "convert": ("-m", "shaftprint", "convert", "{path}", "-o", "{path}.nc", "--force", "--no-progress"),
    "prepare_signals": ("-m", "benchmarks.prepare_script", "{path}"),
}


def run(repetitions: int) -> None:
    """Measure row 12 and print it."""
    print("\n## Row 12: a recording of over 1 GB of another logger")
    with TemporaryDirectory() as folder:
        native = Path(folder) / "thesis.nc"
        sail(load_vessel("stan-tug-1205"), load_campaign("thesis"), native, seed=1)
        rows = []
        for name, (ending, write) in FORMATS.items():
            path = Path(folder) / f"large{ending}"
            with read_recording(native) as recording:
                write(path, [*recording.channels.values(), *_noise(next(iter(recording.channels.values())))])
            size_mb = path.stat().st_size / 1e6
            for work, words in WORK.items():
                runs = [run_process(*(word.format(path=path) for word in words)) for _ in range(repetitions)]
                rows.append(_row(name, size_mb, work, runs))
            path.unlink()
            path.with_name(f"{path.name}.nc").unlink()
    print_table("Whole processes", ("format", "file, MB", "work", "wall, s", "CPU, s", "peak memory, MB"), rows)


def _row(name: str, size_mb: float, work: str, runs: list[Run]) -> tuple[str, ...]:
    wall, cpu = Spread(tuple(run.wall_s for run in runs)), Spread(tuple(run.cpu_s for run in runs))
    peak = max(run.peak_mb for run in runs)
    return (name, f"{size_mb:.0f}", work, wall.text(digits=1), cpu.text(digits=1), f"{peak:.0f}")


def _noise(like: Channel) -> list[Channel]:
    """Return channels of noise on the clock of another."""
    block = np.random.default_rng(1).integers(-30_000, 30_000, 1_000_003).astype(np.int16)
    return [
        Channel(
            name=f"noise_{number}",
            unit="V",
            rate_hz=like.rate_hz,
            start_s=like.start_s,
            count=like.count,
            scale=10.0 / 32_768.0,
            source=lambda start, stop, first=97 * number: block[np.arange(start + first, stop + first) % block.size],
        )
        for number in range(MORE_CHANNELS)
    ]

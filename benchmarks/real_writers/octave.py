"""What Octave's ``save`` writes."""

import shutil
import subprocess
from pathlib import Path

import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid

FORMS = (
    "-text",
    "-binary",
    "-float-binary",
    "-hdf5",
    "-float-hdf5",
    "-v4",
    "-v6",
    "-v7",
    "-text -zip",
    "-binary -zip",
    "csvwrite",
    "dlmwrite",
)


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Let Octave write one file."""
    program = shutil.which("octave-cli") or shutil.which("octave")
    if program is None:
        raise FileNotFoundError("octave")
    form, where = str(options["form"]), str(options.get("where", "top"))
    count, rate = 200, 100.0
    target = str(path)
    made = f"t = (0:{count - 1})'/{rate}; M_s = 100*sin(0.1*(0:{count - 1})'); n = int16(1:{count})';"
    if form == "-v4":
        # version 4 has no whole numbers: Octave leaves the file cut off at the first
        made = made.replace("int16(1:", "(1:")
    if form == "csvwrite":
        script = f"{made} csvwrite('{target}', [t M_s double(n)]);"
    elif form == "dlmwrite":
        script = f"{made} dlmwrite('{target}', [t M_s double(n)], ';', 'precision', 15);"
    elif where == "struct":
        script = f"{made} s.t = t; s.M_s = M_s; s.n = n; save('{form.split()[0]}', '{target}', 's');"
    else:
        more = "".join(f", '{word}'" for word in form.split()[1:])
        script = f"{made} save('{form.split()[0]}'{more}, '{target}', 't', 'M_s', 'n');"
    subprocess.run([program, "--no-gui", "--norc", "--eval", script], check=True, capture_output=True)
    times, index = grid(count, rate), np.arange(count)
    single = 1e-5 if "float" in form else 6e-4 if form == "csvwrite" else 0.0
    torque = TrueChannel(
        times_s=times, values=100.0 * np.sin(0.1 * index), rounding=single + 1e-9, time_rounding_s=1e-6
    )
    speed = TrueChannel(times_s=times, values=index + 1.0)
    names = ("M_s", "n")
    hints = {"columns": "time [s],M_s,n"} if "write" in form else {}
    return Truth(channels=dict(zip(names, (torque, speed), strict=True)), hints=hints)


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    return {"form": FORMS[int(rng.integers(len(FORMS)))]}


EXTREMES: tuple[Options, ...] = (
    *({"form": form} for form in FORMS),
    *({"form": form, "where": "struct"} for form in ("-text", "-hdf5", "-v6", "-v7")),
)
FAMILY = Family(
    name="Octave",
    writer="Octave save",
    suffix=".mat",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=len(EXTREMES),
    damaged=100,
    protects="compressed streams in version 7",
)

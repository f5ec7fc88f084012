"""An FMU of a model: sources, binaries, description, in one file that is written whole or not at all."""

import os
import tempfile
import uuid
import zipfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Final, Literal

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ExportError
from shaftprint.escape import printable
from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_build import PLATFORMS, build_binary, host_platform
from shaftprint.export._fmu_description import (
    FmuDescription,
    build_description,
    description_of_fmi_2,
    description_of_fmi_3,
)
from shaftprint.export._fmu_documentation import documentation
from shaftprint.export._fmu_equations import FmuEquations
from shaftprint.export._fmu_program import FmuProgram, fmu_program, largest_pole
from shaftprint.export._fmu_variables import Variable, variables
from shaftprint.export._model import ExportedModel
from shaftprint.files import written_whole
from shaftprint.models.equations._evaluate import evaluate

CORE: Final = ("core.c", "history.c", "snapshot.c", "start.c", "steady.c", "values.c")
HEADERS: Final = ("core.h", "exchange.h")
LONGEST_STEP_S: Final = 1e-3
SHORTEST_STEP_S: Final = 1e-6
MOST_MOVED: Final = 0.3
STABLE: Final = 2.7
"""Step times fastest pole up to which the rule of Runge and Kutta is stable."""
# The same for all files in an archive, so that equal models give equal files.
DATE: Final = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, kw_only=True, slots=True)
class WrittenFmu:
    """What was written."""

    path: Path
    """The file."""
    version: Literal[2, 3]
    """Version of the interface."""
    platforms: tuple[str, ...]
    """Systems with a binary."""
    failed: tuple[str, ...]
    """A sentence for each system whose binary was asked for and could not be compiled."""
    internal_step_s: float
    """Internal step of co-simulation [s]."""
    largest_pole_rad_s: float
    """Fastest pole over estimate and samples [rad/s]; the step times this stays below 0.3, stable is up to 2.7."""
    largest_step_s: float
    """Longest step that stays stable [s]; 0 where any does."""
    model_exchange: bool
    """Whether a solver from outside can be used too."""
    late_outputs: tuple[str, ...]
    """Outputs that come later than their time stamps in the recording."""


@refusing_none(ExportError)
def write_fmu(
    model: ExportedModel,
    path: str | Path,
    *,
    version: Literal[2, 3] = 2,
    platforms: Sequence[str] | None = None,
    samples: int = 0,
    rng: np.random.Generator | None = None,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> WrittenFmu:
    """Write a model as an FMU for co-simulation and model exchange, with its sources.

    Parameters
    ----------
    path
        File to write; its name without the end is the name of the model in C.
    version
        Version of the Functional Mock-up Interface.
    platforms
        Systems to compile for, of ``PLATFORMS``; this computer's if not given, none for sources only. One that fails
        beside others is left out of the file and stands in ``failed``.
    samples
        How many samples of the parameters it holds besides the estimate.
    rng
        Where these are drawn from; needed for samples.
    overwrite
        Whether an earlier file is replaced.
    progress
        Is told the share of the systems for which it has been compiled, 0 to 1.

    Raises
    ------
    ExportError
        If a number is not finite, a time constant is too short, nothing that was asked for could be compiled, or there
        is no source of samples.
    StructureError
        If a block of the structure has no equations in time.
    FileExistsError
        If the file exists and is not to be replaced.
    """
    if samples and rng is None:
        raise ExportError("FMU of posterior samples: expected rng, a source of random numbers, found none.")
    fmu_path, wanted = Path(path), (host_platform(),) if platforms is None else tuple(dict.fromkeys(platforms))
    ready = fmu_program(model.structure, model.values)
    draws = posterior_deviations(model, samples, rng if rng is not None else np.random.default_rng(0))
    pole = largest_pole(ready, model.values + draws)
    equations = FmuEquations(
        ready=ready,
        inputs=tuple(model.signal(name) for name in ready.program.inputs),
        outputs=tuple(model.signal(name) for name in ready.program.outputs),
        start=model.values,
        settings=(model.engine_speed_rpm, model.shaft_torque_nm, _internal_step(model, pole)),
        draws=draws,
    )
    description, texts = _described(model, equations, identifier(fmu_path.stem), version)
    largest_step_s = STABLE / pole if pole else 0.0
    with written_whole(fmu_path, overwrite=overwrite) as part, tempfile.TemporaryDirectory() as folder:
        page = documentation(model, description, internal_step_s=equations.settings[2], largest_step_s=largest_step_s)
        built, failed = _pack(part, Path(folder), description, texts, page, version, wanted, progress)
    return WrittenFmu(
        path=fmu_path,
        version=version,
        platforms=built,
        failed=failed,
        internal_step_s=equations.settings[2],
        largest_pole_rad_s=pole,
        largest_step_s=largest_step_s,
        model_exchange=description.model_exchange,
        late_outputs=_late_outputs(ready, model),
    )


def _internal_step(model: ExportedModel, pole: float) -> float:
    """Return an internal step in which the fastest signal of all samples does not move by more than ``MOST_MOVED``."""
    if not pole * SHORTEST_STEP_S <= MOST_MOVED:
        raise ExportError(
            f"FMU of {model.structure.name}: expected time constants that steps of {SHORTEST_STEP_S:g} s can follow, "
            f"found a pole at {pole:g} rad/s; hold a time constant that short at zero."
        )
    step = LONGEST_STEP_S
    while step * pole > MOST_MOVED:
        step /= 2.0
    return step


def _described(
    model: ExportedModel, equations: FmuEquations, name: str, version: Literal[2, 3]
) -> tuple[FmuDescription, dict[str, str]]:
    """Return the description of a model, and its sources by name."""
    structure = model.structure
    title = f"{model.title}, {structure.name}"
    interface = f"fmi{version}.c"
    texts = {name: _template(name) for name in (*CORE, *HEADERS, interface)}
    texts["model.c"] = equations.source(title)
    content = "\n".join([title, name, *(texts[key] for key in sorted(texts)), equations.header("")])
    token = "{" + str(uuid.uuid5(uuid.NAMESPACE_URL, content)) + "}"
    texts["model.h"] = equations.header(token)
    description = FmuDescription(
        title=title,
        words=f"{structure.title}; identified by shaftprint{_about(model)}{_remark(model)}",
        identifier=name,
        token=token,
        variables=variables(model, equations),
        indicators=_indicators(equations),
        model_exchange=not equations.ready.asks_input_rates,
        sources=tuple(sorted(key for key in texts if key.endswith(".c"))),
    )
    return description, texts


def _remark(model: ExportedModel) -> str:
    """Return what whoever uses the model must know, as the end of a description."""
    return f"; {printable(model.remark)}" if model.remark else ""


def _about(model: ExportedModel) -> str:
    if not model.is_of_a_ship:
        return ""
    return f" about {model.engine_speed_rpm:.1f} rpm and {model.shaft_torque_nm:.0f} N m"


def _indicators(equations: FmuEquations) -> tuple[Variable, ...]:
    return tuple(
        Variable(
            name=f"event_indicator_{i + 1}",
            reference=equations.references["INDICATOR"] + i,
            causality="local",
            variability="continuous",
            meaning="changes its sign where a limit begins or ends to act",
        )
        for i in range(equations.sizes["INDICATORS"])
    )


def _pack(
    part: Path,
    folder: Path,
    d: FmuDescription,
    texts: dict[str, str],
    page: str,
    version: Literal[2, 3],
    platforms: Sequence[str],
    progress: Callable[[float], None] | None,
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Compile in a folder and write the archive; return the systems of its binaries, and why others have none."""
    members: dict[str, bytes] = {
        "modelDescription.xml": description_of_fmi_2(d) if version == 2 else description_of_fmi_3(d),
        "documentation/index.html": page.encode(),
    }
    for name, text in sorted(texts.items()):
        members[f"sources/{name}"] = text.encode()
        (folder / name).write_bytes(text.encode())
    if version == 3:
        members["sources/buildDescription.xml"] = build_description(d)
    binaries, failed = _binaries(folder, d, platforms, progress)
    for name, binary in binaries.items():
        members[f"{PLATFORMS[name].folder(version)}/{d.identifier}{PLATFORMS[name].suffix}"] = binary
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name, DATE), content, zipfile.ZIP_DEFLATED)
    return tuple(binaries), failed


def _binaries(
    folder: Path, d: FmuDescription, platforms: Sequence[str], progress: Callable[[float], None] | None
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Return the libraries of some systems in their order, and a sentence for each that could not be compiled.

    Each compiler is a process of its own, so that threads are enough to wait for as many as there are cores.
    """
    unknown = [name for name in platforms if name not in PLATFORMS]
    if unknown:
        raise ExportError(
            f"FMU: there is no system {unknown[0]!r}; there are {', '.join(PLATFORMS)}."
            if unknown[0]
            else "FMU: this computer's system has no name among those of FMUs; name one with --platform, or write "
            "sources only."
        )
    paths = {name: folder / name / f"{d.identifier}{PLATFORMS[name].suffix}" for name in platforms}
    built, errors = dict[str, bytes](), dict[str, ExportError]()
    for path in paths.values():
        path.parent.mkdir()
    pool = ThreadPoolExecutor(max_workers=os.cpu_count() or 1)
    try:
        jobs = {pool.submit(build_binary, folder, d.sources, name, path): name for name, path in paths.items()}
        for done, job in enumerate(as_completed(jobs), start=1):
            try:
                job.result()
                built[jobs[job]] = paths[jobs[job]].read_bytes()
            except ExportError as error:
                errors[jobs[job]] = error
            if progress is not None:
                progress(done / len(jobs))
    finally:
        # what has not begun when the user ends the command is not begun any more
        pool.shutdown(cancel_futures=True)
    failed = tuple(errors[name] for name in paths if name in errors)
    if failed and not built:
        raise failed[0]
    return {name: built[name] for name in paths if name in built}, tuple(map(str, failed))


def _template(name: str) -> str:
    return files("shaftprint.export").joinpath("templates", name).read_text(encoding="utf-8")


def _late_outputs(ready: FmuProgram, model: ExportedModel) -> tuple[str, ...]:
    """Return the outputs whose time stamps lie ahead of what can be known, by name."""
    leaves = {("parameter", i): value for i, value in enumerate(model.values)}
    delays_s = evaluate(ready.lateness, leaves)
    names = ready.program.outputs
    return tuple(model.signal(name).name for name, late in zip(names, delays_s, strict=True) if float(late) > 0.0)


MOST_TRIES = 1000


def posterior_deviations(model: ExportedModel, samples: int, rng: np.random.Generator) -> FloatArray:
    """Return what samples of the parameters differ by from the estimate, the estimate first: zeros.

    ``samples``: how many. ``rng``: where they are drawn from: a normal distribution, cut off at the bounds of the
    parameters. Returns shape (1 + samples, parameters). Raises ExportError if the covariance is not known, or hardly a
    sample keeps to the bounds.
    """
    deviations = np.zeros((1 + samples, len(model.structure.parameters)))
    if not samples:
        return frozen_float(deviations)
    if not model.uncertain:
        raise ExportError("FMU of posterior samples: expected parameters with a covariance, found none.")
    places = [model.structure.names.index(name) for name in model.uncertain]
    chosen = [model.structure.parameters[index] for index in places]
    estimate = model.values[places]
    lower = np.minimum([p.lower for p in chosen], estimate)
    upper = np.maximum([p.upper for p in chosen], estimate)
    root = _root(model.covariance_matrix)
    row = 0
    for _ in range(MOST_TRIES * samples):
        step = root @ rng.standard_normal(len(places))
        if np.all((estimate + step >= lower) & (estimate + step <= upper)):
            row += 1
            deviations[row, places] = step
            if row == samples:
                return frozen_float(deviations)
    raise ExportError(
        f"FMU of posterior samples: expected {samples} samples within the bounds of {', '.join(model.uncertain)}, "
        f"found {row} in {MOST_TRIES * samples}: the parameters are too uncertain for samples."
    )


def _root(covariance: FloatArray) -> FloatArray:
    """Return a matrix whose product with its transpose is the covariance, which may be singular."""
    scale = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    return np.asarray(scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0)))

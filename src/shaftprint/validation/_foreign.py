"""An FMU of somebody else as the model that is held against a recording.

It is code of somebody else, and runs with the user's rights: only because the user named it, in a process of its own
that is ended when it takes too long.
"""

import importlib.util
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._thesis import structure
from shaftprint.errors import ValidationError
from shaftprint.escape import printable
from shaftprint.models._structure import Structure
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.validation._model import Model, model_of

EXTRA: Final = 'pip install "shaftprint[models]"'
CHILD: Final = Path(__file__).with_name("_fmu_child.py")
VARIABLES: Final[Mapping[str, str]] = MappingProxyType(
    {"set_point": "engine_speed_set_point", "speed": "engine_speed", "torque": "shaft_torque"}
)
"""What is asked of a model, and what shaftprint's own FMUs call it."""
# In which a model that does not begin in steady running comes to it.
BEFORE_S: Final = 60.0
LONGEST_S: Final = 600.0
# Speed over set point before the record: further off it is another shaft's, in another unit, or does not run.
FARTHEST: Final = 0.5
SHOWN: Final = 400


@dataclass(frozen=True, kw_only=True, slots=True)
class ForeignModel:
    """An FMU and what its variables are."""

    path: Path
    """The FMU, FMI 2 or 3 for co-simulation."""
    working_point: WorkingPoint
    """About which the recording is normalised."""
    variables: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    """Name and unit of set point, speed and torque not called as in ``VARIABLES``; an empty unit is the FMU's."""
    longest_s: float = LONGEST_S
    """How long it may run [s]."""

    @property
    def model(self) -> Model:
        """What a validation shows of it: its name, and that nothing is stated of its parameters."""
        return model_of(structure("CL4"), name=printable(self.path.name))

    def predict(
        self,
        structure: Structure,
        values: FloatArray,
        set_point: FloatArray,
        *,
        rate_hz: float,
        wanted: Sequence[str] = (),
    ) -> tuple[FloatArray, FloatArray]:
        """Return deviations of speed and torque from the working point, and no derivatives; see ``Predict``.

        Raises ValidationError if the FMU is not there, cannot be run, or takes too long.
        """
        point = self.working_point
        speed_rev_s = (1.0 + set_point) * point.engine_speed_rev_s
        outputs = self._run(speed_rev_s, rate_hz)
        ratio = outputs[0, 0] / speed_rev_s[0]
        if not abs(ratio - 1.0) <= FARTHEST:
            raise self._error(
                f"expected the engine's speed near its set point before the record, found {ratio:.3g} times that; "
                "name the variable of the engine's speed and its unit with --model-variable"
            )
        scale = np.array([[point.engine_speed_rev_s], [point.shaft_torque_nm]])
        return outputs / scale - 1.0, np.empty((0, 2, set_point.size))

    def _run(self, set_point_rev_s: FloatArray, rate_hz: float) -> FloatArray:
        if importlib.util.find_spec("fmpy") is None:
            raise self._error(f"running an FMU needs FMPy; {EXTRA}")
        if not self.path.is_file():
            raise self._error("expected an FMU, found no file")
        unknown = [role for role in self.variables if role not in VARIABLES]
        if unknown:
            raise self._error(f"there is no {unknown[0]!r}; a model has {', '.join(VARIABLES)}")
        job = {
            "fmu": str(self.path.resolve()),
            "variables": {role: self.variables.get(role, (name, "")) for role, name in VARIABLES.items()},
            "rate_hz": rate_hz,
            "before_s": BEFORE_S,
        }
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "job.json").write_text(json.dumps(job), encoding="utf-8")
            np.save(folder / "set_point.npy", set_point_rev_s)
            try:
                # our own file, and a folder of our own
                done = subprocess.run(  # noqa: S603
                    [sys.executable, "-P", str(CHILD), name], capture_output=True, timeout=self.longest_s, check=False
                )
            except subprocess.TimeoutExpired:
                raise self._error(f"expected it to end within {self.longest_s:g} s; it was ended") from None
            if (folder / "problem.txt").is_file():
                raise self._error(printable((folder / "problem.txt").read_text(encoding="utf-8"))[:SHOWN])
            if done.returncode != 0 or not (folder / "outputs.npy").is_file():
                raise self._error(f"its process ended with {done.returncode}, without a result")
            return np.asarray(np.load(folder / "outputs.npy", allow_pickle=False), dtype=float)

    def _error(self, words: str) -> ValidationError:
        return ValidationError(f"model {printable(self.path.name)}: {words}.")

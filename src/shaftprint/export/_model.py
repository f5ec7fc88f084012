"""What is exported: a structure with its values, where it holds and how well it is known."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, block_of, frozen_float
from shaftprint.errors import ExportError
from shaftprint.export._fmu_signals import DEVIATION, FmuSignal, fmu_signal
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_fingerprint import LineFingerprint
from shaftprint.fingerprint._model import identified_model, model_with_limits, named_structure
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ExportedModel(Shown):
    """A structure with values, its working point, and the covariance of what was identified."""

    title: str
    """Name of the vessel and its shaft line, or whatever the model is of."""
    structure: Structure
    """The structure."""
    values: FloatArray
    """All its parameters, shape (parameters,)."""
    engine_speed_rpm: float = 1.0
    """Engine speed of the working point [rpm]; of no use for a drive."""
    shaft_torque_nm: float = 1.0
    """Shaft torque at the gauge of the working point [N m]; of no use for a drive."""
    uncertain: tuple[str, ...] = ()
    """Parameters whose uncertainty is known."""
    covariance: FloatArray | None = None
    """Their covariance, shape (uncertain, uncertain); None where there are none."""
    not_known: tuple[str, ...] = ()
    """Parameters of which the test said nothing."""
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """95 % intervals of parameters whose standard deviation does not tell what the interval tells."""
    remark: str = ""
    """What whoever uses it must know, such as that it fails its own validation; empty where there is nothing."""
    source: str = ""
    """Which fingerprint it is of, in words; empty where it is of none."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Unit of each input and output of a drive, which are whole values; empty for a ship's line."""

    def __post_init__(self) -> None:
        """Check that every number may stand in a file that others compute with.

        Raises ExportError if a number is not finite, the working point is zero, or shapes do not fit.
        """
        if self.values.shape != (len(self.structure.parameters),):
            raise ExportError(
                f"export of {self.structure.name}: expected {len(self.structure.parameters)} values, found an array "
                f"of shape {self.values.shape}."
            )
        wrong = [n for n, value in zip(self.structure.names, self.values, strict=True) if not np.isfinite(value)]
        if wrong:
            raise ExportError(
                f"export of {self.structure.name}: expected finite values, found none of {', '.join(wrong)}; give "
                "them values."
            )
        for name, value in (("engine speed", self.engine_speed_rpm), ("shaft torque", self.shaft_torque_nm)):
            if not np.isfinite(value) or value == 0.0:
                raise ExportError(f"export: expected a working point with an {name} that is not zero, found {value}.")
        size = len(self.uncertain)
        covariance = self.covariance_matrix
        if covariance.shape != (size, size) or not np.all(np.isfinite(covariance)):
            raise ExportError(f"export: expected a finite covariance of {size} parameters, found {covariance.shape}.")

    def summary(self) -> Summary:
        """Return which model it is, and what of it is known."""
        facts = {
            "structure": f"{self.structure.name}: {self.structure.title}",
            "working point": f"{self.engine_speed_rpm:.1f} rpm, {self.shaft_torque_nm:.0f} N m"
            if self.is_of_a_ship
            else "",
            "values": shortened(f"{n} {v:.4g}" for n, v in zip(self.structure.names, self.values, strict=True)),
            "uncertain": shortened(self.uncertain),
            "not known": shortened(self.not_known),
        }
        return Summary(title=f"Model of {self.title}", facts=facts)

    @property
    def is_of_a_ship(self) -> bool:
        """Whether it deviates from the working point of a ship's line, which a drive does not have."""
        return not self.units

    def signal(self, name: str) -> FmuSignal:
        """Return what an input or output is outside of the equations."""
        if self.is_of_a_ship:
            return fmu_signal(name)
        return FmuSignal(name, self.units[name], DEVIATION, is_whole=False, meaning=f"{name} of the drive")

    @property
    def covariance_matrix(self) -> FloatArray:
        """The covariance, shape (uncertain, uncertain)."""
        return frozen_float(np.zeros((0, 0))) if self.covariance is None else self.covariance

    @property
    def std(self) -> dict[str, float]:
        """Standard deviation of each uncertain parameter by name."""
        return dict(zip(self.uncertain, np.sqrt(np.diag(self.covariance_matrix)).tolist(), strict=True))


@refusing_none(ExportError)
def exported_model(fingerprint: Fingerprint, *, of: Structure | None = None, linear: bool = False) -> ExportedModel:
    """Return the model of a fingerprint, with the covariance of its parameters.

    Parameters
    ----------
    of
        The structure that was identified; the shipped one of its name if not given.
    linear
        Whether the linear model is wanted although the fingerprint has the line with its limits. A structure that is
        given is the linear one.

    Raises
    ------
    FingerprintError
        If there is no shipped structure of that name, or it has other parameters than the fingerprint.
    """
    line = None if linear or of is not None else fingerprint.with_limits
    if line is None:
        model = identified_model(fingerprint, named_structure(fingerprint) if of is None else of)
        quantities = fingerprint.parameters
    else:
        model, quantities = model_with_limits(line), line.parameters
    std = {quantity.name: quantity.std for quantity in quantities}
    uncertain = tuple(name for name in std if np.isfinite(std[name]) and std[name] > 0.0)
    return ExportedModel(
        title=fingerprint.conditions.vessel,
        structure=model.structure,
        values=model.values,
        engine_speed_rpm=fingerprint.conditions.engine_speed.value,
        shaft_torque_nm=fingerprint.conditions.shaft_torque.value,
        uncertain=uncertain,
        intervals={q.name: q.interval_95 for q in quantities if q.interval_95 and q.stated_std is None},
        covariance=frozen_float(block_of(model.covariance, [p.name for p in model.structure.free], uncertain)),
        not_known=model.not_known,
        remark=validation_remark(fingerprint, model.structure.name),
    )


def source_words(fingerprint: LineFingerprint) -> str:
    """Return which fingerprint a model is of: of what it is, when it was made, and of which recording."""
    sha256 = fingerprint.recording_sha256
    return (
        f"Fingerprint of {fingerprint.title}, identified on {fingerprint.created:%Y-%m-%d} by shaftprint "
        f"{fingerprint.shaftprint_version}{f', of the recording with SHA-256 {sha256}' if sha256 else ''}."
    )


def validation_remark(fingerprint: Fingerprint, structure: str) -> str:
    """Return what the validation of a fingerprint says against one of its models; empty where nothing."""
    record = fingerprint.validation
    return record.remark if record is not None and record.model == structure else ""

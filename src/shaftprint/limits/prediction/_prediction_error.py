"""The likelihood of a governor: one-step prediction errors of the engine's torque, white at their best colour."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._fit_percent import fit_percent
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._term import FittedTerm, Repeats, TermTest, WhitenedTerm
from shaftprint.identify.likelihood._term_check import TermCheck
from shaftprint.limits._candidates import IDLE
from shaftprint.limits.prediction._noise_colour import Innovations, innovations, without_gaps
from shaftprint.limits.prediction._recent_simulations import RecentSimulations
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.models._structure import Structure
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays
from shaftprint.time_domain._simulator import on_record as simulated_on
from shaftprint.time_domain._span import qr_reduced

# Longest step of the simulation [s].
LONGEST_STEP_S = 0.01
# Cost of a simulation that runs away.
AWAY = 1e9
OUTPUT = "y"
# The rate limit of the set point acts before the equations; the step of its derivative, as a share of it.
RATE, RATE_STEP = GovernorSymbol.SET_POINT_RATE, 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PredictedTorque(FittedTerm):
    """The torque over the load as a governor predicts it."""

    structure: Structure
    """The structure, with its held and free parameters."""
    record: Record
    """The data."""
    predicted: FloatArray
    """Predicted torque over the load [-], shape (samples,)."""
    fit_percent: Mapping[str, float]
    """FitPercent of the torque (thesis eq. 2.41)."""

    @property
    def fit_ceiling(self) -> Mapping[str, float]:
        """The same: all that the governor leaves of the torque counts as noise."""
        return self.fit_percent

    @property
    def seconds(self) -> float:
        """Length of the used samples [s]."""
        return int(self.record.used.sum()) / self.record.rate_hz

    @property
    def checks(self) -> tuple[TermCheck, ...]:
        """Nothing: which limits act is what the search compares."""
        return ()

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"recording {self.record.name}"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PredictionError(WhitenedTerm):
    """A governor with some free limits, and the test that it is fitted to."""

    whole: Structure
    """The same with everything free: one compiled simulation serves all limits."""
    record: GovernorRecord
    """The data."""
    scale: float = 1.0
    """Standard deviation of the innovations, by which they are divided."""
    longest_step_s: float = LONGEST_STEP_S
    """Longest step of its simulations [s]."""
    recent: RecentSimulations = field(default_factory=RecentSimulations, repr=False)
    """What was simulated last; the same in other units and with other free parameters."""

    @classmethod
    def of(
        cls, whole: Structure, record: GovernorRecord, values: Mapping[str, float], free: Sequence[str]
    ) -> "PredictionError":
        """Return the likelihood in which some parameters are free, from values of all on.

        ``whole``: the structure with all limits. ``values``: value of every parameter; those that are not free stay,
        also beyond their bounds. ``free``: names of the free ones.
        """
        bounds = {p.name: (p.lower, p.upper) for p in whole.parameters}
        fixed = {name: float(np.clip(values[name], *bounds[name])) for name in whole.names if name not in free}
        structure = whole.held_at(**fixed)
        places = tuple(whole.names.index(p.name) for p in structure.free)
        return cls(
            structure=structure,
            whole=whole,
            record=record,
            held=frozen_float(np.array([values[name] for name in whole.names])),
            free=places,
            places=places,
            columns=tuple(range(len(places))),
        )

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"recording {self.record.name}"

    @property
    def data_count(self) -> int:
        """Number of used samples."""
        return int(np.count_nonzero(self.record.used))

    @property
    def innovation_count(self) -> int:
        """Number of innovations: of used samples whose whole past is used."""
        return int(np.count_nonzero(without_gaps(self.record.used)))

    @property
    def null_cost(self) -> float:
        """Half the square sum of the innovations of the measured torque itself."""
        return 0.5 * innovations(self._measured, self.record.used).squares / self.scale**2

    @property
    def _measured(self) -> FloatArray:
        return np.asarray(self.record.outputs[OUTPUT])

    def with_scale_at(self, values: FloatArray) -> "PredictionError":
        """Return the term with the innovations of some parameters as its unit.

        Raises IdentificationError if the simulation runs away there.
        """
        at_values = self.innovations(values)
        if at_values is None:
            raise IdentificationError(f"{self.name}: the simulation of {self.structure.name} runs away.")
        return replace(self, scale=float(np.sqrt(at_values.squares / at_values.count)))

    def innovations(self, values: FloatArray) -> Innovations | None:
        """Return the innovations at all parameters of the structure; None where the simulation runs away."""
        simulated = self.simulated(values, ())
        return None if simulated is None else innovations(self._measured - simulated[0], self.record.used)

    def predicted(self, values: FloatArray) -> FloatArray:
        """Return the predicted torque over the load, shape (samples,); infinite where the simulation runs away."""
        simulated = self.simulated(values, ())
        return np.full(self.record.samples, np.inf) if simulated is None else simulated[0]

    def residuals(self, values: FloatArray) -> FloatArray:
        """Return what the prediction leaves of the measured torque over the load, shape (samples,)."""
        return np.asarray(self._measured - self.predicted(values))

    def rows(self, values: FloatArray) -> FloatArray | None:
        """Return innovations over their deviation and below them their derivatives, shape (1 + free, innovations)."""
        simulated = self.simulated(values, [self.whole.names[column] for column in self.free])
        if simulated is None:
            return None
        at_values = innovations(self._measured - simulated[0], self.record.used)
        return np.concatenate([at_values.values[None], at_values.filtered(-simulated[1:])]) / self.scale

    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return QR-reduced innovations and derivatives, shape (starts, 1 + free, 1 + free)."""
        table = np.zeros((theta.shape[0], self.row_count, self.row_count))
        for start, values in enumerate(self.complete(theta)):
            rows = self.rows(values)
            if rows is None:
                table[start, 0, 0] = np.sqrt(2.0 * AWAY)
            else:
                table[start] = qr_reduced(rows)
        return table

    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return whether the simulation of each start stays within bounds, shape (starts,)."""
        return np.array([self.simulated(values, ()) is not None for values in self.complete(theta)])

    def assessed(self, values: FloatArray, number: int) -> tuple[PredictedTorque, TermTest]:
        """Return FitPercent; whether the innovations are small has no meaning, for they are the unit."""
        structure_values = self.structure_values(values)
        simulated, at_values = self.simulated(structure_values, ()), self.innovations(structure_values)
        if simulated is None or at_values is None:
            raise IdentificationError(
                f"{self.name}: the simulation of {self.structure.name} runs away at the parameters that were found."
            )
        used = self.record.used
        pair = (values[used].astype(np.complex128) for values in (self._measured, simulated[0]))
        part = PredictedTorque(
            structure=self.structure,
            record=self.record,
            predicted=frozen_float(simulated[0]),
            fit_percent={OUTPUT: fit_percent(*pair)},
        )
        count = at_values.count
        distance = at_values.squares / self.scale**2
        line = LineTest(
            experiment=number, name=self.record.name, distance=distance, data_count=count, excess=float(np.inf)
        )
        return part, TermTest(chi_square=distance, count=count, mean=float(count), variance=2.0 * count, lines=(line,))

    def redrawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> Repeats:
        """Refuse: the speed that drives the governor holds the noise that would have to be drawn anew."""
        raise IdentificationError(f"{self.name}: repeats of a governor on its measured speed cannot be drawn.")

    def simulated(self, values: FloatArray, wanted: Sequence[str]) -> FloatArray | None:
        """Return prediction and derivatives, shape (1 + wanted, samples); None where it runs away."""
        again = self.recent.found(self.record, values, wanted)
        if again is not None:
            return again
        simulated = self._simulated_anew(values, wanted)
        if simulated is not None:
            self.recent.keep(self.record, values, wanted, simulated)
        return simulated

    @property
    def _simulator(self) -> ExactDelays:
        return ExactDelays(longest_step_s=self.longest_step_s)

    def _simulated_anew(self, values: FloatArray, wanted: Sequence[str]) -> FloatArray | None:
        inside = [name for name in wanted if name != RATE]
        simulated = simulated_on(self._simulator, self.whole, values, self._record_at(values), inside)
        if simulated is None or len(inside) == len(wanted):
            return None if simulated is None else simulated[:, :, 0]
        change = self._change_with_rate(values)
        return None if change is None else np.insert(simulated[:, :, 0], 1 + list(wanted).index(RATE), change, axis=0)

    def _record_at(self, values: FloatArray) -> Record:
        """Return the record with the set point as its limited rate leaves it."""
        rate = float(values[self.whole.names.index(RATE)])
        if rate >= IDLE[RATE]:
            return self.record
        # the rate is that of the demand, which is the recorded set point times its scale
        limited = self.record.set_point_at(rate / float(values[self.whole.names.index(GovernorSymbol.SET_POINT_SCALE)]))
        return replace(self.record, drive={**self.record.drive, "n_set": limited})

    def _change_with_rate(self, values: FloatArray) -> FloatArray | None:
        """Return the change of the prediction with the rate of the set point, shape (samples,): no equation has it."""
        column = self.whole.names.index(RATE)
        ends = []
        for side in (-1.0, 1.0):
            moved = values.copy()
            moved[column] *= 1.0 + side * RATE_STEP
            simulated = simulated_on(self._simulator, self.whole, moved, self._record_at(moved), ())
            if simulated is None:
                return None
            ends.append(simulated[0, :, 0])
        return np.asarray((ends[1] - ends[0]) / (2.0 * RATE_STEP * values[column]))

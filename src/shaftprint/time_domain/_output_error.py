"""The likelihood of a record: what a simulation leaves of the outputs, made white.

With the filter ``W`` that makes the noise white, measured ``y``, simulated ``f(theta)`` and the columns ``B`` of
offset, drift and, where asked for, initial states, the cost is ``min_c |W (y - f - B c)|^2 / 2`` (output error: Ljung,
System Identification: Theory for the User, second edition, sections 4.2 and 7.4, with a fixed noise model). The rows of
a record are QR-reduced to ``1 + free`` columns: 50 starts of a long record fit into memory.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._term import Repeats, TermTest, WhitenedTerm
from shaftprint.time_domain._assumed import shortened
from shaftprint.time_domain._flexible_model import FlexibleModel
from shaftprint.time_domain._initial_states import InitialStates, KnownStates, best_states, spread_of, state_estimates
from shaftprint.time_domain._input_response import excited
from shaftprint.time_domain._moving_load import load_columns, with_quadratic_torque, without_quadratic_torque
from shaftprint.time_domain._noise_model import LONGEST_S
from shaftprint.time_domain._nuisance import drift_columns, left_of, orthonormal, without
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._record_fit import RecordFit, record_fit
from shaftprint.time_domain._record_repeats import RecordRepeats
from shaftprint.time_domain._simulator import Simulator, in_parallel, on_record
from shaftprint.time_domain._span import INDEPENDENT, Span, qr_reduced
from shaftprint.time_domain._whitening import Whitening

# Cost of a simulation that runs away, over that of no model at all.
AWAY = 1e12
# What offsets leave of a slope below this share of it is rounding: the parameter is one with the offset, and a search
# that followed such a slope would go anywhere.
ROUNDING = 1e-10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OutputError(WhitenedTerm):
    """A structure and a record to fit it to, with the colour of its noise."""

    record: Record
    """The data."""
    whitening: Whitening
    """The filter that makes their noise white."""
    simulator: Simulator
    """How the structure is simulated."""
    drift_degree: int
    """Highest power of time in what is projected out: 0 for offsets, 1 for drifts, -1 for nothing."""
    anew_after_s: float
    """A gap longer than this [s] begins offset and drift anew."""
    initial_states: bool
    """Whether the states at the start are estimated; else the record begins in steady running."""
    moving_load: bool = False
    """Whether the propeller's load may move, for structures with speed ``n`` and torque ``M_s`` of a propeller that
    takes the square of the speed: the torque is compared without that square."""
    longest_memory_s: float = LONGEST_S
    """Longest memory of the noise that is tried [s]."""
    assumed: FloatArray | None = None
    """What one standard deviation of each assumed parameter changes, shape (assumed, samples, outputs)."""
    measured: FloatArray = field(init=False, repr=False)
    """Whitened outputs, shape (used samples * outputs,)."""
    drifts: FloatArray = field(init=False, repr=False)
    """Orthonormal basis of the whitened offsets and drifts, shape (rank, used samples * outputs)."""

    def __post_init__(self) -> None:
        """Whiten what does not depend on parameters."""
        object.__setattr__(self, "measured", frozen_float(self._white(self._compared(self._outputs())[None])[0]))
        object.__setattr__(self, "drifts", frozen_float(orthonormal(self._white(self._columns()))))

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"record {self.record.name}"

    @property
    def data_count(self) -> int:
        """Number of used samples of all outputs, less the offsets and drifts."""
        return int(self.measured.size - self.drifts.shape[0])

    @property
    def null_cost(self) -> float:
        """Half the square sum of the whitened outputs, offset and drift apart."""
        return 0.5 * float(np.sum(without(self.measured, self.drifts) ** 2))

    def with_noise(self, whitening: Whitening) -> "OutputError":
        """Return the term with another noise."""
        return replace(self, whitening=whitening)

    def with_assumed(self, assumed: Mapping[str, float], values: FloatArray) -> "OutputError":
        """Return the term with held parameters that are assumed, by their standard deviations, as they act at values.

        Raises
        ------
        IdentificationError
            If the simulation runs away there.
        """
        names = [name for name in assumed if name in self.structure.names]
        if not names:
            return self
        spread = np.array([assumed[name] for name in names])
        return replace(self, assumed=spread[:, None, None] * self._evaluated(values, names)[1][1:])

    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return QR-reduced residuals and derivatives, a simulation a start, shape (starts, 1 + free, 1 + free)."""
        return self._table(theta, repeats, [None] * theta.shape[0], np.arange(theta.shape[0]))

    def following(self, starts: int) -> Callable[[FloatArray, IntArray], FloatArray]:
        """Return ``table`` for one descent: states at the start follow those where each of the starts was lowest."""
        known: list[KnownStates | None] = [None] * starts
        return lambda theta, rows: self._table(theta, None, known, rows)

    def _table(
        self, theta: FloatArray, repeats: Repeats | None, known: list[KnownStates | None], rows: IntArray
    ) -> FloatArray:
        table = np.zeros((theta.shape[0], self.row_count, self.row_count))
        values = self.complete(theta)

        def fill(start: int) -> None:
            data = repeats.data(start) if isinstance(repeats, RecordRepeats) else self.measured
            before, own = known[rows[start]], values[start]
            run = self._run(own, data, first=None if before is None else before.at(own, self.free))
            if run is None:
                table[start, 0, 0] = np.sqrt(2.0 * AWAY * max(self.null_cost, 1.0))
                return
            left = self._projected(run[1], run[0], data)[0]
            table[start] = qr_reduced(left)
            if run[0] is not None and (before is None or left[0] @ left[0] < before.cost):
                along = (without(self._white(one), self.drifts) for one in (run[0].effects, run[1][1:]))
                known[rows[start]] = KnownStates.of(run[0], float(left[0] @ left[0]), *along)

        in_parallel(fill, theta.shape[0])
        return table

    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return whether the simulation of each start stays within bounds, shape (starts,)."""
        finite = np.zeros(theta.shape[0], dtype=np.bool_)
        values, names = self.complete(theta), [self.structure.names[column] for column in self.free]

        def fill(start: int) -> None:
            # with derivatives, as a search will ask for them: a kernel less is compiled
            finite[start] = self._simulated(values[start], names) is not None

        in_parallel(fill, theta.shape[0])
        return finite

    def assessed(self, values: FloatArray, number: int) -> tuple[RecordFit, TermTest]:
        """Return FitPercent and whitened residuals, and how much of these the inputs still explain."""
        structure_values = self.structure_values(values)
        start, simulated = self._evaluated(structure_values)
        rows, basis = self._projected(simulated, start, self.measured)
        part = record_fit(
            self.structure,
            self.record,
            self.whitening.noise,
            model=self._completed(simulated[0], start),
            whitened=rows[0].reshape(-1, len(self._names)),
            initial_states=() if start is None else state_estimates(start, self._white(start.effects), self.drifts),
            offsets=self._offsets(start, simulated[0]),
            flexible=self._flexible(simulated, start),
        )
        test = self._tested(rows, basis)
        line = LineTest(
            experiment=number, name=self.record.name, distance=test[0], data_count=test[1], excess=float(np.inf)
        )
        return part, TermTest(
            chi_square=test[0], count=test[1], mean=float(test[1]), variance=2.0 * test[1], lines=(line,)
        )

    def beside(
        self, values: FloatArray, covariance: FloatArray, *, stopped: BoolArray
    ) -> tuple[tuple[Estimate, ...], tuple[Estimate, ...]]:
        """Return states at the start and offsets with their standard deviations; none of what is not estimated.

        Parameters
        ----------
        values
            All parameters of the structure, shape (parameters,).
        covariance
            Covariance of the free ones, shape (free, free).
        stopped
            Which of these stand at a bound, shape (free,): offsets are those beside them there.
        """
        start, simulated = self._evaluated(values)
        slopes = self._white(simulated[1:])
        states: tuple[Estimate, ...] = ()
        if start is not None:
            effects = self._white(start.effects)
            states = state_estimates(start, effects, self.drifts, slopes=slopes, covariance=covariance)
        hidden = ~np.isfinite(np.diag(covariance)) & slopes.any(axis=1)
        hidden &= ~self._projected(simulated, start, self.measured)[0][1:].any(axis=1)
        known = stopped | hidden
        within = np.where(known[:, None] | known, 0.0, covariance)
        # what an offset takes whole may be anywhere between its bounds, and the offset goes with it
        wide = np.array([self.structure.parameters[i].upper - self.structure.parameters[i].lower for i in self.free])
        within[hidden, hidden] = wide[hidden] ** 2
        return states, self._offsets(start, simulated[0], slopes=slopes, covariance=within)

    def start_effects(self, values: FloatArray) -> FloatArray:
        """Return what each state at the start does, shape (states, samples, outputs); none where it runs away."""
        first = self.simulator.rest(self.structure, values, self.record)
        run = self._simulated(values, (), first)
        return np.zeros((0, self.record.samples, len(self._names))) if run is None else run[1:]

    def redrawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> RecordRepeats:
        """Return repeats with noise of the same colour."""
        _, simulated = self._evaluated(self.structure_values(values))
        return RecordRepeats(model=self._white(simulated[:1])[0], seeds=rng.integers(0, 2**62, size=count))

    def model(self, values: FloatArray) -> FloatArray:
        """Return simulated outputs with their best offset, drift and initial states, shape (samples, outputs).

        Parameters
        ----------
        values
            All parameters of the structure, shape (parameters,).

        Raises
        ------
        IdentificationError
            If the simulation runs away.
        """
        start, simulated = self._evaluated(values)
        return self._completed(simulated[0], start)

    def residuals(self, values: FloatArray) -> FloatArray:
        """Return what the model leaves of the outputs as they are compared; see ``model``."""
        return self._compared(self._outputs()) - self._compared(self.model(values))

    def rows(self, values: FloatArray) -> FloatArray | None:
        """Return whitened residuals and derivatives, shape (1 + free, used samples * outputs); None if it runs away."""
        run = self._run(values, self.measured)
        return None if run is None else self._projected(run[1], run[0], self.measured)[0]

    def _projected(
        self, simulated: FloatArray, start: InitialStates | None, data: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return whitened residuals of a simulation with derivatives beside offsets, drifts and initial states."""
        basis = self.drifts
        if start is not None:
            effects = left_of(self._white(start.effects), self.drifts)
            basis = orthonormal(np.concatenate([self.drifts, effects]))
        rows = self._white(simulated)
        rows[0] = data - rows[0]
        rows[1:] *= -1.0
        left = without(rows, basis)
        if self.assumed is not None:
            left = shortened(left, left_of(self._white(self.assumed), basis))
        taken = np.abs(left[1:]).max(axis=1) <= ROUNDING * np.abs(rows[1:]).max(axis=1)
        left[1:][taken] = 0.0
        return left, basis

    def _evaluated(self, values: FloatArray, wanted: Sequence[str] = ()) -> tuple[InitialStates | None, FloatArray]:
        """Return initial states and the simulation from them with its derivatives, for the data of the record.

        Raises IdentificationError if the simulation runs away.
        """
        run = self._run(values, self.measured, wanted)
        if run is None:
            raise IdentificationError(
                f"{self.name}: the simulation of {self.structure.name} runs away at these parameters; narrow the "
                "bounds, or start from a fit to a frequency response."
            )
        return run

    def _run(
        self, values: FloatArray, data: FloatArray, wanted: Sequence[str] = (), *, first: FloatArray | None = None
    ) -> tuple[InitialStates | None, FloatArray] | None:
        """Return initial states where they are estimated, and the simulation from them; None where it runs away.

        ``first``: states near the best ones, shape (states,); those of steady running if not given.
        """
        names = wanted or [self.structure.names[column] for column in self.free]
        if not self.initial_states:
            simulated = self._simulated(values, names)
            return None if simulated is None else (None, simulated)
        estimate = best_states(
            lambda states: self._simulated(values, names, states),
            # a state that is nearly one with an offset would be moved for ever
            lambda rows: left_of(self._white(rows), self.drifts, least=INDEPENDENT),
            data=without(data, self.drifts),
            first=self.simulator.rest(self.structure, values, self.record) if first is None else first,
            near=first is not None,
        )
        if estimate is None:
            return None
        states, run = estimate
        simulated, effects = run[: 1 + len(names)], run[1 + len(names) :]
        start = InitialStates(structure=self.structure, record=self.record, own=values, values=states, effects=effects)
        return start, simulated

    def _completed(self, simulated: FloatArray, start: InitialStates | None) -> FloatArray:
        """Return a simulation with its best offset and drift as the record shows it, shape (samples, outputs)."""
        completed = simulated
        if self._columns().size:
            # the last step towards the states was small, but drifts and states may have moved against each other
            completed = completed + np.tensordot(self._shares(simulated, start), self._linear(start), axes=1)
        return (
            with_quadratic_torque(completed, self._names, self.record.load)
            if self.moving_load
            else np.asarray(completed)
        )

    def _shares(self, simulated: FloatArray, start: InitialStates | None) -> FloatArray:
        """Return the best weights of offsets, drifts and moving load, and of the states at the start behind them."""
        gap = self.measured - self._white(simulated[None])[0]
        shares, *_ = np.linalg.lstsq(self._white(self._linear(start)).T, gap, rcond=1e-9)
        return np.asarray(shares)

    def _linear(self, start: InitialStates | None) -> FloatArray:
        """Return what is found beside the model: offsets, drifts, moving load, effects of states at the start."""
        return self._columns() if start is None else np.concatenate([self._columns(), start.effects])

    def _offsets(
        self,
        start: InitialStates | None,
        simulated: FloatArray,
        *,
        slopes: FloatArray | None = None,
        covariance: FloatArray | None = None,
    ) -> tuple[Estimate, ...]:
        """Return what offset and drift add to each output on average; the parameters are known without covariance."""
        drifts = self._drift_columns()
        if not len(drifts):
            return ()
        columns, shares = self._linear(start), self._shares(simulated, start)
        spread = spread_of(self._white(columns), slopes=slopes, covariance=covariance)
        means = np.zeros((len(columns), len(self._names)))
        means[: len(drifts)] = drifts[:, self.record.used].mean(axis=1)
        return tuple(
            Estimate(name=name, unit="", value=float(mean @ shares), std=spread.std(mean))
            for name, mean in zip(self._names, means.T, strict=True)
        )

    def _flexible(self, simulated: FloatArray, start: InitialStates | None) -> FlexibleModel:
        """Return what is more flexible than the structure, to judge it by."""
        measured = self._outputs()
        return FlexibleModel(
            record=self.record,
            names=self._names,
            measured=measured,
            residuals=self._compared(measured) - self._compared(self._completed(simulated[0], start)),
            simulated=simulated[0],
            slopes=simulated[1:],
            parameters=tuple(self.structure.names[column] for column in self.free),
            noise=self.whitening.noise,
            nuisance=np.concatenate([self._linear(start), *([] if self.assumed is None else [self.assumed])]),
            longest_memory_s=self.longest_memory_s,
        )

    def _compared(self, values: FloatArray) -> FloatArray:
        """Return outputs as they are compared, without the square of the speed where the load may move."""
        return without_quadratic_torque(values[None], self._names, self.record.load)[0] if self.moving_load else values

    def _simulated(
        self, values: FloatArray, wanted: Sequence[str], initial: FloatArray | None = None
    ) -> FloatArray | None:
        """Return outputs and derivatives, those to the states at the start too where these are given."""
        simulated = on_record(self.simulator, self.structure, values, self.record, wanted, initial=initial)
        if simulated is None or not self.moving_load:
            return simulated
        return without_quadratic_torque(simulated, self._names, self.record.load)

    def _columns(self) -> FloatArray:
        """Return offsets, drifts and moving load, shape (columns, samples, outputs)."""
        drifts = self._drift_columns()
        return np.concatenate([drifts, load_columns(self.record, self._names)]) if self.moving_load else drifts

    def _drift_columns(self) -> FloatArray:
        """Return offsets and drifts, shape (columns, samples, outputs)."""
        return drift_columns(self.record, len(self._names), self.drift_degree, anew_after_s=self.anew_after_s)

    @property
    def _names(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return tuple(self.structure.outputs)

    def _white(self, values: FloatArray) -> FloatArray:
        """Return whitened rows, shape (rows, used samples * outputs), from (rows, samples, outputs)."""
        white = self.whitening.whitened(values, self.record.stretches)
        return white.reshape(white.shape[0], white.shape[1] * white.shape[2])

    def _outputs(self) -> FloatArray:
        """Return the measured outputs, shape (samples, outputs)."""
        return np.stack([self.record.outputs[name] for name in self.structure.outputs], axis=1)

    def _tested(self, rows: FloatArray, basis: FloatArray) -> tuple[float, int]:
        """Return how much of the residuals lies along inputs and parameters, and in how many directions."""
        moves, size = excited(self.record), len(self.structure.outputs)
        directions = np.zeros((size, *moves.shape, size))
        for output in range(size):
            directions[output, :, :, output] = moves
        table = self._white(directions.reshape(-1, self.record.samples, size))
        span = Span.of(left_of(np.concatenate([rows[1:], table]), basis))
        return span.explained(rows[0]), span.rank

"""The noun of the room: a measured frequency response with its covariance."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import (
    BoolArray,
    ComplexArray,
    FloatArray,
    RealOrComplexArray,
    frozen_bool,
    frozen_complex,
    frozen_float,
)
from shaftprint.errors import ResponseError
from shaftprint.notebook._labelled import Labelled, LabelledData, Variable
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.reasons import Reason
from shaftprint.spectra._response_covariance import weight_change


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FrequencyResponse(Shown, Labelled):
    """A response from one or more inputs to one or more outputs at given lines, with full covariance.

    The covariance of a line is that of the real vector ``[Re H, Im H]``, where ``H`` runs over the outputs (and, for
    several inputs, over outputs times inputs in C order). Lines are taken as independent of each other.

    Frequency, response, covariance and the names of inputs and outputs are enough, from any source and in any units.
    Where only a standard deviation or a coherence is known, ``circular_covariance`` and ``coherence_covariance`` make
    the covariance; from time series, ``response_from_arrays`` makes all of it.
    """

    frequency_hz: FloatArray
    """Frequency of each line [Hz], ascending, shape (lines,)."""
    response: ComplexArray
    """Response, output over input: of a ship normalised values over normalised values [-], of another drive in the
    units of its data; shape (outputs, inputs, lines)."""
    covariance: FloatArray
    """Covariance of [Re, Im], shape (lines, 2 outputs inputs, 2 outputs inputs). It is right as a weight: the errors
    ``r`` of a line give ``r^T C^-1 r`` the mean ``2 outputs inputs``. One estimated from ``n`` complex samples is
    therefore larger than the mean square of the errors, by ``n / (n - outputs)``."""
    inputs: tuple[str, ...]
    """Names of the inputs, such as ``("n_set",)``."""
    outputs: tuple[str, ...]
    """Names of the outputs, such as ``("n", "M_s")``."""
    lines: tuple[str, ...] = ()
    """Names of the lines, such as ``("S1", ...)``; numbered when empty."""
    degrees_of_freedom: FloatArray = field(default_factory=lambda: np.empty(0))
    """Real degrees of freedom behind each covariance, shape (lines,); infinite, as for a known one, when not given."""
    used: BoolArray = field(default_factory=lambda: np.empty(0, dtype=np.bool_))
    """Which lines a fit should use by default, shape (lines,); all when not given."""
    remarks: Mapping[str, str] = field(default_factory=dict)
    """Why a line is not used, by line name."""
    load: RealOrComplexArray = field(default_factory=lambda: np.empty(0))
    """Propeller load of each line over that at the working point [-], shape (lines,); 1 when not given. Complex where
    the square of a speed of many lines adds to it."""
    common: Mapping[str, ComplexArray] = field(default_factory=dict)
    """Causes that move all outputs of a line together, by name: change of the response when the cause changes by its
    standard deviation, shape (outputs, inputs, lines). The covariance contains them."""
    averaging_s: float = 0.0
    """Window over which the speed output is a mean [s]; see ``SpeedSignal``."""
    hold_s: float = 0.0
    """Time for which a speed value is held [s]."""
    pick_up_delay_s: float = 0.0
    """Delay of the speed output behind the true speed [s]."""
    reasons: tuple[Reason, ...] = ()
    """What speaks against the response: what was found on the signals and lines that it was made of."""
    middle_s: FloatArray = field(default_factory=lambda: np.empty(0))
    """Middle of the window of each line, in seconds of the recording, shape (lines,); empty when not given."""
    input_late_s: float | None = None
    """By how much a filter or hold in the channel of the input may make it late that the sizes of its sines do not
    contradict [s]; None where they were not held against what was asked for."""
    input_drift: float | None = None
    """Time that the input loses a second against what was asked for [-], by the clock of its channel or of whoever put
    it out; None where that is not known to a few millionths."""
    input_jump_s: FloatArray = field(default_factory=lambda: np.empty(0))
    """By how much later each line of the input came than the first, against what was asked for, where all after one
    instant did, shape (lines,) [s]; empty where none did."""

    @property
    def weight_factors(self) -> FloatArray:
        """By what each covariance is larger than that of the errors, as it is estimated, shape (lines,); 1 if known."""
        return weight_change(self.degrees_of_freedom, 0, len(self.outputs))

    def summary(self) -> Summary:
        """Return what answers to what, at which lines."""
        hertz = self.frequency_hz
        facts = {
            "from": shortened(self.inputs),
            "to": shortened(self.outputs),
            "lines": shortened(self.lines),
            "band": f"{hertz.min():.4g} to {hertz.max():.4g} Hz" if hertz.size else "",
            "not used": shortened(name for name, used in zip(self.lines, self.used, strict=True) if not used),
        }
        return Summary(title=f"FrequencyResponse of {len(self.lines)} lines", facts=facts)

    def labelled(self) -> LabelledData:
        """Return response, standard deviations and covariance over output, input and line."""
        shape, axes = self.response.shape, ("output", "input", "line")
        std = np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2)).T.reshape(2, *shape)
        components = [
            f"{part} {out}/{source}" for part in ("Re", "Im") for out in self.outputs for source in self.inputs
        ]
        degrees = np.degrees(np.unwrap(np.angle(self.response)))
        along = {
            "frequency_hz": Variable(dims=("line",), values=self.frequency_hz, unit="Hz", meaning="frequency"),
            "used": Variable(dims=("line",), values=self.used, meaning="whether a fit uses it by default"),
            "response": Variable(dims=axes, values=self.response, unit="-", meaning="output over input"),
            "magnitude": Variable(dims=axes, values=np.abs(self.response), unit="-", meaning="magnitude"),
            "phase_deg": Variable(dims=axes, values=degrees, unit="deg", meaning="phase, unwrapped"),
            "real_std": Variable(dims=axes, values=std[0], unit="-", meaning="standard deviation of the real part"),
            "imaginary_std": Variable(
                dims=axes, values=std[1], unit="-", meaning="standard deviation of the imaginary part"
            ),
            "covariance": Variable(
                dims=("line", "component", "component_too"),
                values=self.covariance,
                unit="-",
                meaning="covariance of all real, then all imaginary parts",
            ),
        }
        names = {
            "output": self.outputs,
            "input": self.inputs,
            "line": self.lines,
            "component": components,
            "component_too": components,
        }
        coordinates = {name: Variable(dims=(name,), values=np.array(labels)) for name, labels in names.items()}
        return LabelledData(rows=axes, variables=along, coordinates=coordinates)

    def __post_init__(self) -> None:
        """Check shapes and make all arrays read-only.

        Raises ResponseError if names are missing or double, a shape does not fit, a frequency is not positive and
        ascending, a value is not finite, a number of degrees of freedom is not positive, or a covariance is not
        symmetric and positive definite.
        """
        for kind in ("inputs", "outputs", "lines"):
            object.__setattr__(self, kind, _distinct(kind, getattr(self, kind)))
        count = np.size(self.frequency_hz)
        if not self.lines:
            object.__setattr__(self, "lines", tuple(f"line {number}" for number in range(1, count + 1)))
        if len(self.lines) != count:
            raise ResponseError(f"lines: expected {count} names, one a frequency, found {len(self.lines)}.")
        channels = len(self.outputs) * len(self.inputs)
        one_a_line = (count,)
        dof = self.degrees_of_freedom if np.size(self.degrees_of_freedom) else np.full(count, np.inf)
        used = self.used if np.size(self.used) else np.ones(count, dtype=np.bool_)
        load = self.load if np.size(self.load) else np.ones(count)
        for name, array, shape in (
            ("frequency_hz", frozen_float(self.frequency_hz), one_a_line),
            ("response", frozen_complex(self.response), (len(self.outputs), len(self.inputs), count)),
            ("covariance", frozen_float(self.covariance), (count, 2 * channels, 2 * channels)),
            ("degrees_of_freedom", frozen_float(dof), one_a_line),
            ("used", frozen_bool(used), one_a_line),
            ("middle_s", frozen_float(self.middle_s), one_a_line if np.size(self.middle_s) else (0,)),
            ("input_jump_s", frozen_float(self.input_jump_s), one_a_line if np.size(self.input_jump_s) else (0,)),
            ("load", frozen_complex(load) if np.iscomplexobj(load) else frozen_float(load), one_a_line),
        ):
            _expect_shape(name, array, shape)
            object.__setattr__(self, name, array)
        common = {name: frozen_complex(change) for name, change in self.common.items()}
        for name, change in common.items():
            _expect_shape(f"common error {name}", change, self.response.shape)
        object.__setattr__(self, "common", common)
        self._check_values()

    def _check_values(self) -> None:
        frequency = self.frequency_hz
        if frequency.size == 0 or not np.all(frequency > 0.0) or not np.all(np.diff(frequency) > 0.0):
            raise ResponseError("frequency_hz: expected positive, ascending frequencies in Hz.")
        for name in ("response", "covariance"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise ResponseError(f"{name}: found values that are not finite.")
        if not np.all(self.degrees_of_freedom > 0.0):
            raise ResponseError("degrees_of_freedom: expected positive numbers, infinite for a known covariance.")
        scale = np.abs(self.covariance).max(axis=(1, 2), keepdims=True)
        if np.any(np.abs(self.covariance - np.swapaxes(self.covariance, 1, 2)) > 1e-9 * scale):
            raise ResponseError("covariance: expected symmetric matrices of [Re, Im].")
        lost = np.linalg.eigvalsh(self.covariance)[:, 0] <= 0.0
        if lost.any():
            name = self.lines[int(np.argmax(lost))]
            raise ResponseError(f"covariance of {name}: expected a positive definite matrix.")

    @property
    def omega_rad_s(self) -> FloatArray:
        """Angular frequency of each line [rad/s], shape (lines,)."""
        return 2.0 * np.pi * self.frequency_hz

    def of_outputs(self, *names: str) -> "FrequencyResponse":
        """Return the response of some of the outputs, in the given order.

        Their rows and columns of the covariance are taken, those of every input. A covariance estimated from few
        samples becomes a little smaller, since fewer outputs are then weighted together (see ``weight_change``).

        Parameters
        ----------
        names
            Names of the outputs to keep.

        Returns
        -------
        The smaller response; everything else is as before.

        Raises
        ------
        ResponseError
            If no name is given, one is given twice, or the response has no such output.
        """
        places = _places("output", names, self.outputs)
        inputs, count = len(self.inputs), len(self.outputs) * len(self.inputs)
        rows = np.array([index * inputs + i for index in places for i in range(inputs)])
        both = np.concatenate([rows, rows + count])
        change = weight_change(self.degrees_of_freedom, len(self.outputs), len(names))
        return replace(
            self,
            outputs=tuple(names),
            response=self.response[places],
            covariance=change[:, np.newaxis, np.newaxis] * self.covariance[:, both[:, np.newaxis], both],
            common={name: np.sqrt(change) * part[places] for name, part in self.common.items()},
        )

    def of_lines(self, *names: str) -> "FrequencyResponse":
        """Return the response at some of the lines, in ascending frequency whatever the order of the names.

        Parameters
        ----------
        names
            Names of the lines to keep.

        Returns
        -------
        The smaller response, with the names of its lines.

        Raises
        ------
        ResponseError
            If no name is given, one is given twice, or the response has no such line.
        """
        return self._at_lines(sorted(_places("line", names, self.lines)))

    def between(self, lowest_hz: float, highest_hz: float) -> "FrequencyResponse":
        """Return the response at the lines of a band of frequencies, borders included.

        Parameters
        ----------
        lowest_hz, highest_hz
            Borders of the band [Hz].

        Returns
        -------
        The smaller response, with the names of its lines.

        Raises
        ------
        ResponseError
            If the band holds no line.
        """
        places = np.flatnonzero((self.frequency_hz >= lowest_hz) & (self.frequency_hz <= highest_hz)).tolist()
        if not places:
            raise ResponseError(
                f"between {lowest_hz:g} and {highest_hz:g} Hz: found no line; the response has lines from "
                f"{self.frequency_hz[0]:g} to {self.frequency_hz[-1]:g} Hz."
            )
        return self._at_lines(places)

    def _at_lines(self, places: list[int]) -> "FrequencyResponse":
        names = tuple(self.lines[index] for index in places)
        return replace(
            self,
            frequency_hz=self.frequency_hz[places],
            response=self.response[:, :, places],
            covariance=self.covariance[places],
            lines=names,
            degrees_of_freedom=self.degrees_of_freedom[places],
            used=self.used[places],
            remarks={name: remark for name, remark in self.remarks.items() if name in names},
            load=self.load[places],
            middle_s=self.middle_s[places] if self.middle_s.size else self.middle_s,
            input_jump_s=self.input_jump_s[places] if self.input_jump_s.size else self.input_jump_s,
            common={name: part[:, :, places] for name, part in self.common.items()},
        )


def _distinct(kind: str, names: Sequence[str]) -> tuple[str, ...]:
    if isinstance(names, str):
        raise ResponseError(f'{kind}: expected a tuple of names such as ("{names}",), found the text {names!r}.')
    if len(set(names)) != len(names):
        raise ResponseError(f"{kind}: expected different names, found {', '.join(names)}.")
    if not names and kind != "lines":
        raise ResponseError(f"{kind}: expected at least one name, found none.")
    return tuple(names)


def _places(kind: str, names: tuple[str, ...], known: tuple[str, ...]) -> list[int]:
    unknown = [name for name in names if name not in known]
    if unknown or not names:
        raise ResponseError(
            f"{kind} {', '.join(map(repr, unknown)) or 'not given'}: the response has {', '.join(known)}."
        )
    _distinct(f"{kind}s", names)
    return [known.index(name) for name in names]


def _expect_shape(name: str, values: ArrayLike, shape: tuple[int, ...]) -> None:
    if np.shape(values) != shape:
        raise ResponseError(f"{name}: expected shape {shape}, found {np.shape(values)}.")

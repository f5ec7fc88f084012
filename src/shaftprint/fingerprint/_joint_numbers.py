"""The numbers of the ship together: their covariance by what the test left open and what was stated beforehand.

Two tests are compared with it along causes (``drift``): governor gains are known to a few per cent each, and to a few
per mille against each other.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Self

import numpy as np
from pydantic import Field, model_validator

from shaftprint.arrays import FloatArray, block_of
from shaftprint.fingerprint._covariance_check import covariance_fault
from shaftprint.fingerprint._physical import GAUGE_ZERO, physical_numbers
from shaftprint.fingerprint._working_point_share import GAIN
from shaftprint.identify.uncertainty._joint import JointCovariance, joint_covariance
from shaftprint.records import Record

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

# Each test has a zero of its own: it drifts, and is taken anew. What its gain lost unseen is of the test too.
OF_THE_TEST = ("gauge zero", GAIN)


class JointNumbers(Record):
    """Covariance of the numbers that are of the ship, not of its sensors or the load of the day."""

    names: tuple[str, ...] = Field(max_length=100)
    """Physical values, and parameters in which the working point does not stand."""
    own_covariance: tuple[tuple[float, ...], ...]
    """What the test itself leaves open, in the order of the names and the squares of their units."""
    loadings: dict[str, tuple[float, ...]]
    """Change of each number, with sign, for one standard deviation of each source that was stated beforehand."""

    @model_validator(mode="after")
    def _expect_covariance(self) -> Self:
        size = len(self.names)
        if len(set(self.names)) < size:
            raise ValueError("names: expected each name once")
        # nan where it cannot be: the check says so
        std = [math.sqrt(abs(row[at])) if at < len(row) else math.nan for at, row in enumerate(self.own_covariance)]
        fault = covariance_fault(self.own_covariance, std if len(std) == size else [math.nan] * size)
        if not fault and not all(map(math.isfinite, std)):
            fault = "expected finite numbers, found others"
        if fault:
            raise ValueError(f"own_covariance: {fault}")
        for source, change in self.loadings.items():
            if len(change) != size or not all(map(math.isfinite, change)):
                raise ValueError(f"loadings of {source[:100]!r}: expected {size} finite numbers, found others")
        return self

    def covariance_of(self, names: tuple[str, ...]) -> FloatArray:
        """Return the own covariance of some of the numbers, shape (names, names)."""
        return block_of(self.own_covariance, self.names, names)

    def loadings_of(self, names: tuple[str, ...]) -> dict[str, FloatArray]:
        """Return the change of some of the numbers by source, shape (names,) each."""
        places = [self.names.index(name) for name in names]
        return {source: np.array(change)[places] for source, change in self.loadings.items()}


def joint_numbers(
    identification: "Identification",
    working_point: "WorkingPoint",
    vessel: "Vessel",
    shifts: Mapping[str, Mapping[str, float]],
) -> JointNumbers:
    """Return the joint covariance of the physical values and of the parameters that are of the line alone.

    ``identification``, ``working_point``, ``vessel``: the fit, where it was made, and what was tested. ``shifts``: what
    the working point does to the parameters, see ``shifts_of_working_point``.
    """
    numbers = physical_numbers(identification, working_point, vessel)
    chosen = [item for item in numbers if item.number.name != GAUGE_ZERO]
    parameters = (one.name for one in identification.parameters if one.role is not None and one.role.is_of_line)
    joint = joint_covariance(
        identification,
        (*(item.number.name for item in chosen), *parameters),
        [item.number for item in chosen],
        direct={item.number.name: item.direct for item in chosen},
        shifts=shifts,
        of_the_test=OF_THE_TEST,
    )
    return kept_together(joint)


def kept_together(joint: JointCovariance) -> JointNumbers:
    """Return what is kept of a joint covariance."""
    return JointNumbers(
        names=joint.names,
        own_covariance=tuple(tuple(row) for row in joint.own.tolist()),
        loadings={source: tuple(change.tolist()) for source, change in joint.loadings.items()},
    )

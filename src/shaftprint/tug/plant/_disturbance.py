"""Coloured disturbances of the process, carried from chunk to chunk."""

import math
from typing import NamedTuple, Self

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.kernels._compiled import compiled
from shaftprint.tug._noise import Noise


class _Resonance(NamedTuple):
    """Second-order colouring ``x'' + 2 zeta omega x' + omega^2 x = white``."""

    stiffness: float
    damping: float
    add: float


class _Colour(NamedTuple):
    """Coefficients of the colouring recursions for one time step."""

    step_s: float
    inflow_keep: float
    inflow_add: float
    demand_keep: float
    demand_add: float
    surge: _Resonance
    combustion: _Resonance
    hunting: _Resonance


@compiled(inline="always")
def _swing(step_s, resonance, white, state, place):  # type: ignore[no-untyped-def]
    """Step one resonance, whose value and rate stand at ``place`` and the place after it."""
    # semi-implicit Euler: stable and, at a hundredth of a period a step, exact enough for noise
    rate = state[place + 1]
    rate += resonance.add * white - step_s * (resonance.stiffness * state[place] + resonance.damping * rate)
    state[place + 1] = rate
    state[place] += step_s * rate


@compiled(nogil=True)
def _colour(  # type: ignore[no-untyped-def]
    white: FloatArray,
    colour,
    state: FloatArray,
    propeller: FloatArray,
    engine: FloatArray,
    demand: FloatArray,
) -> None:
    """Fill the disturbances at the start of the chunk and after each of its steps; ``state`` is carried."""
    propeller[0] = state[0] + state[2]
    engine[0] = state[4] + state[6]
    demand[0] = state[1]
    for j in range(white.shape[0]):
        state[0] = colour.inflow_keep * state[0] + colour.inflow_add * white[j, 0]
        state[1] = colour.demand_keep * state[1] + colour.demand_add * white[j, 1]
        _swing(colour.step_s, colour.surge, white[j, 2], state, 2)
        _swing(colour.step_s, colour.combustion, white[j, 3], state, 4)
        _swing(colour.step_s, colour.hunting, white[j, 4], state, 6)
        propeller[j + 1] = state[0] + state[2]
        engine[j + 1] = state[4] + state[6]
        demand[j + 1] = state[1]


class Disturbance:
    """Stream of the disturbances of propeller torque, engine torque and speed demand at the nodes of the steps."""

    def __init__(self, noise: Noise, step_s: float, rng: np.random.Generator) -> None:
        self._rng = rng
        inflow_keep = math.exp(-2.0 * math.pi * noise.inflow_corner_hz * step_s)
        demand_keep = math.exp(-2.0 * math.pi * noise.demand_corner_hz * step_s)
        swings = (
            (noise.surge_rms, noise.surge_hz, noise.surge_damping),
            (noise.combustion_rms, noise.combustion_hz, noise.combustion_damping),
            (noise.hunting_rms, noise.hunting_hz, noise.hunting_damping),
        )
        surge, combustion, hunting = (_resonance(*swing, step_s) for swing in swings)
        self._colour = _Colour(
            step_s=step_s,
            inflow_keep=inflow_keep,
            inflow_add=noise.inflow_rms * math.sqrt(1.0 - inflow_keep**2),
            demand_keep=demand_keep,
            demand_add=noise.demand_rms * math.sqrt(1.0 - demand_keep**2),
            surge=surge,
            combustion=combustion,
            hunting=hunting,
        )
        # start in the stationary state: neither the inflow nor the surge begins with the recording
        spread = [noise.inflow_rms, noise.demand_rms]
        for rms, frequency_hz, _ in swings:
            spread += [rms, rms * 2.0 * math.pi * frequency_hz]
        self._state: FloatArray = np.array(spread) * rng.standard_normal(len(spread))

    @classmethod
    def none(cls, step_s: float) -> Self:
        """Return a stream of zeros."""
        return cls(Noise().without(process=True), step_s, np.random.default_rng(0))

    def next(self, steps: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the next disturbances of propeller, engine and demand [fraction], each of shape (steps + 1,)."""
        propeller, engine, demand = (np.empty(steps + 1) for _ in range(3))
        white = self._rng.standard_normal((steps, 5))
        _colour(white, self._colour, self._state, propeller, engine, demand)
        return propeller, engine, demand


def _resonance(rms: float, frequency_hz: float, damping: float, step_s: float) -> _Resonance:
    """Return the colouring that gives the rms: white noise of intensity q has the variance q / (4 zeta omega^3)."""
    omega = 2.0 * math.pi * frequency_hz
    return _Resonance(
        stiffness=omega**2,
        damping=2.0 * damping * omega,
        add=rms * math.sqrt(4.0 * damping * omega**3 * step_s),
    )

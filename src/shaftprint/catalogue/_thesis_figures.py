"""The sensitivity analyses of the thesis as structures with its values and bounds (figures 4.2-4.8, B.1-B.4, D.1)."""

from dataclasses import dataclass
from typing import Literal

from shaftprint.catalogue._thesis import structure
from shaftprint.models._blocks import Gain, PIGovernor
from shaftprint.models._shaft_blocks import Shaft
from shaftprint.models._structure import Structure

Data = Literal["core", "governor"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Family:
    """One sensitivity figure of the thesis."""

    figure: str
    """Number of the figure, such as ``4.2``."""
    structure: Structure
    """Structure with the bounds and values of the figure."""
    output: str
    """Output that is drawn."""
    vary: tuple[str, ...]
    """Parameters that are varied."""
    data: Data | None = None
    """Which open-loop response the thesis draws beside it."""


def thesis_families() -> tuple[Family, ...]:
    """Return the sensitivity analyses of the thesis in the order of their figures."""
    initial = structure("INITIAL")
    five = ("tau_n", "K_p", "K_i", "g", "v")
    return (
        Family(figure="4.2", structure=initial, output="n", vary=five),
        Family(figure="4.3", structure=_open_loop(initial), output="n", vary=("tau_n", "K_p", "K_i", "v")),
        *_sub_models(),
        Family(figure="B.1-B.2", structure=initial, output="E_n", vary=five),
        Family(figure="B.3-B.4", structure=initial, output="M_s", vary=five),
        Family(figure="D.1", structure=_simplified(initial), output="n", vary=("tau_n", "K_p", "K_i")),
    )


def _open_loop(initial: Structure) -> Structure:
    """Return ``n / e`` of thesis eq. 4.4: the initial linear model without feedback and with ``g = 0``."""
    by_name = {parameter.name: parameter for parameter in initial.parameters}
    governor = PIGovernor(by_name["K_p"], by_name["K_i"]) * Gain(by_name["v"])
    core = Shaft((by_name["tau_n"],), by_name["k_q"])
    return Structure(
        name="OPEN-LOOP", title="open loop of the initial linear model", input="e", outputs={"n": governor * core}
    )


def _sub_models() -> tuple[Family, ...]:
    """Return the sub-models of thesis sections 4.3 and 4.4 with the values given there."""
    second = structure("OL2").free_between(K_p=(0.0, 15.0), K_i=(0.0, 10.0))
    second = _valued(second, K_p=5.0, K_i=3.0)
    pid = _valued(structure("OL-PID"), K_p=10.0, K_i=3.0, K_d=1.0, T_f=0.01)
    delayed = _valued(structure("OL3"), K_p=3.0, K_i=4.0)
    lagged = structure("OL4").free_between(omega_n=(6.0, 18.0), zeta=(0.0, 1.0))
    lagged = _valued(lagged, K_p=3.0, K_i=4.0, omega_n=10.0, zeta=0.5)
    core = structure("OL1").free_between(tau_n=(0.0, 3.0))
    return (
        Family(figure="4.4", structure=core, output="n", vary=("tau_n",), data="core"),
        Family(figure="4.5", structure=second, output="M_s", vary=("K_p", "K_i"), data="governor"),
        Family(figure="4.6", structure=pid, output="M_s", vary=("K_d", "T_f"), data="governor"),
        Family(figure="4.7", structure=delayed, output="M_s", vary=("t_d",), data="governor"),
        Family(figure="4.8", structure=lagged, output="M_s", vary=("omega_n", "zeta"), data="governor"),
    )


def _simplified(initial: Structure) -> Structure:
    """Return the closed loop with ``g = 0`` and ``v = 1`` of thesis appendix D."""
    return initial.held_at(g=0.0, v=1.0)


def _valued(model: Structure, **values: float) -> Structure:
    """Return the structure with other default values of the named parameters, their bounds as before."""
    bounds = {p.name: (p.lower, p.upper) for p in model.parameters if p.name in values}
    return model.held_at(**values).free_between(**bounds)

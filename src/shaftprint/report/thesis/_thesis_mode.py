"""The same recording treated the thesis' way, and why the numbers differ."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import plain, rounded
from shaftprint.normalisation import inertia_time_s
from shaftprint.plain_table import Symbol, Table, numbers, texts
from shaftprint.spectra._open_loop import open_loop

if TYPE_CHECKING:
    from shaftprint.survey._thesis_mode import ThesisMode
    from shaftprint.vessel._vessel import Vessel

GOVERNOR_FITS = ("OL2", "OL3", "OL4", "OL5")
SHOWN = ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta")


def calculated_inertia_time_s(thesis: "ThesisMode", vessel: "Vessel") -> float:
    """Return ``2 pi I n_s0 / M_s0`` with the inertia upstream of the gauge [s] (thesis eq. 5.1: 1.016 s)."""
    point = thesis.signals.working_point
    return inertia_time_s(
        vessel.inertia_upstream_kg_m2,
        shaft_speed_rev_s=point.engine_speed_rev_s / vessel.gearbox.ratio,
        shaft_torque_nm=point.shaft_torque_nm,
    )


def thesis_findings(thesis: "ThesisMode", vessel: "Vessel") -> tuple[str, ...]:
    """Return what goes wrong in the thesis' way on this recording, and why, in words."""
    return (*_inertia(thesis, vessel), *_governor(thesis), *_aliased(thesis))


def _inertia(thesis: "ThesisMode", vessel: "Vessel") -> list[str]:
    core = thesis.identifications.get("OL1")
    if core is None:
        return []
    tau_n = core.of_role(ShipRole.INERTIA).value
    calculated = calculated_inertia_time_s(thesis, vessel)
    below = calculated * vessel.inertia_downstream_kg_m2 / vessel.inertia_upstream_kg_m2
    sensor = thesis.signals.engine_speed.delay_s
    return [
        f"OL1 finds tau_n = {rounded(tau_n)} s where the torsional vibration calculation upstream of the gauge gives "
        f"{rounded(calculated)} s: a factor {plain(calculated / tau_n, 2)}. The two are not the same inertia. The "
        "response from shaft torque to speed sees only what lies downstream of the gauge (flange, shaft, propeller, "
        f"entrained water), for which the vessel file gives {rounded(below)} s. The rest of the difference comes from "
        f"the speed sensor, whose value is {plain(1000.0 * sensor, 1)} ms late in thesis mode and looks like inertia."
    ]


def _governor(thesis: "ThesisMode") -> list[str]:
    fits = {name: thesis.identifications[name] for name in GOVERNOR_FITS if name in thesis.identifications}
    if len(fits) < 2:
        return []
    percent = [fit.fit_percent["M_s"] for fit in fits.values()]
    gain = [fit.of_role(ShipRole.PROPORTIONAL_GAIN).value for fit in fits.values()]
    governor, _ = open_loop(thesis.spectra.response)
    share = np.abs(governor.response[0, 0]) ** 2
    share = 100.0 * share / share.sum()
    first, second = governor.lines[0], governor.lines[1]
    return [
        f"{', '.join(fits)} reach FitPercent {plain(min(percent), 1)} to {plain(max(percent), 1)} %, nearly the same, "
        f"though their K_p lie between {rounded(min(gain), 3)} and {rounded(max(gain), 3)}. The criterion cannot tell "
        f"them apart: {first} alone carries {plain(float(share[0]), 0)} % of the squared response M_s / e, {first} and "
        f"{second} together {plain(float(share[:2].sum()), 0)} %, and K_p has no influence there."
    ]


def _aliased(thesis: "ThesisMode") -> list[str]:
    sensor = thesis.signals.engine_speed
    response = thesis.spectra.response
    chosen = (response.frequency_hz > sensor.nyquist_hz) & response.used
    if not chosen.any():
        return []
    names = [line for line, alias in zip(response.lines, chosen, strict=True) if alias]
    return [
        f"{' and '.join(names)} lie above {plain(sensor.nyquist_hz, 2)} Hz, half the pulse rate of {sensor.name}: what "
        "the speed shows there is an alias of another frequency. The thesis' way fits them all the same; shaftprint "
        "leaves them out."
    ]


def thesis_fit_table(thesis: "ThesisMode") -> Table:
    """Return parameters and FitPercent of the unweighted fits (as thesis tables 5.2 and 5.3)."""
    rows: list[tuple[str, ...]] = []
    for name, fit in thesis.identifications.items():
        values = tuple(
            rounded(fit.value(parameter)) if parameter in fit.structure.names else "–" for parameter in SHOWN
        )
        percent = tuple(f"{plain(fit.fit_percent[o], 2)}" if o in fit.fit_percent else "–" for o in ("n", "M_s"))
        margin = fit.margins
        rows.append((name, *values, *percent, "–" if margin is None else plain(margin.gain_margin, 2)))
    return Table(
        title="Unweighted fits in thesis mode (thesis, tables 5.2 and 5.3)",
        columns=(
            *texts("structure"),
            *numbers(*(Symbol(name) for name in (*SHOWN, "FitPercent n", "FitPercent M_s")), "gain margin"),
        ),
        rows=tuple(rows),
        note="Units: s, -, 1/s, s, rad/s, -. FitPercent of M_s / e for OL2 to OL5, of n / M_s for OL1.",
    )

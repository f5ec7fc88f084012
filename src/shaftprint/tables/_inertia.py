"""Tables on the inertia by calculation and on the torsional modes."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain, rounded, unit_text, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.torsion._expected_inertia import ExpectedInertia, ExpectedValue, InertiaComparison
    from shaftprint.torsion._modes import Modes
    from shaftprint.torsion._two_masses import TwoMasses
    from shaftprint.vessel._vessel import Vessel

# Sources with a smaller share of the variance are put together.
SMALL_SHARE = 0.01
ASSUMED = "assumed"
SHOWN_MODES = 6


def mass_table(vessel: "Vessel") -> Table:
    """Return the inertia table of a vessel, each row on its own shaft and at the propeller shaft."""
    ratio = vessel.gearbox.ratio
    return Table(
        title="Inertia table of the vessel file",
        columns=(
            *texts("mass"),
            *numbers("on its shaft [kg m²]"),
            *texts("shaft"),
            *numbers("at the propeller shaft [kg m²]"),
            *texts("of the gauge", "source"),
        ),
        rows=tuple(
            (
                row.name,
                _pair(row.inertia_kg_m2, row.std_kg_m2 or 0.0),
                row.shaft,
                _pair(row.referred_kg_m2(ratio), row.referred_std_kg_m2(ratio)),
                row.gauge,
                row.source,
            )
            for row in vessel.inertia
        ),
        symbols=True,
        note=f"Inertias on the engine shaft count {rounded(ratio)} squared, the gear ratio, at the propeller shaft.",
    )


def expected_inertia_table(expected: "ExpectedInertia", beside: "Sequence[InertiaComparison]" = ()) -> Table:
    """Return sums and inertia times by calculation, beside those that a test found where there are such."""
    identified = {row.expected.name: row for row in beside}
    columns = (*texts("quantity"), *numbers("calculated ± std"))
    columns += numbers("identified ± std", "difference over its std") * bool(identified)
    rows = tuple(
        (
            item.name,
            with_deviation(item.value, item.std),
            *(_identified(identified.get(item.name)) * bool(identified)),
            unit_text(item.unit),
            item.meaning,
        )
        for item in (*expected.sums, *expected.times)
    )
    note = (
        f"“{ASSUMED}”: this number went into the fit as a prior, so that finding it again says nothing. Both "
        "deviations count in the last difference."
    )
    return Table(
        title=f"Inertia by calculation{' beside the identified' if identified else ''}, at the propeller shaft",
        columns=(*columns, *texts("unit", "meaning")),
        rows=rows,
        note=note if identified else "",
        symbols=True,
    )


def inertia_budget_table(expected: "ExpectedInertia") -> Table:
    """Return what each source does to the expected inertia times, largest first."""
    rows = [row for item in expected.times for row in _sources(item)]
    return Table(
        title="Uncertainty of the calculated inertia times",
        columns=(*texts("quantity", "source"), *numbers("change for one std [s]", "share of the variance")),
        rows=tuple(rows),
        symbols=True,
        note="A gauge that shows too much makes both times too small.",
    )


def water_table(expected: "ExpectedInertia") -> Table:
    """Return the entrained water by each method, and the downstream side with it."""
    return Table(
        title="Entrained water by each method, in place of the water of the inertia table",
        columns=(*texts("method"), *numbers("water [kg m²]", "I_dn [kg m²]", "tau_dn [s]"), *texts("from")),
        rows=tuple(
            (
                wet.water.method,
                with_deviation(wet.water.water_kg_m2, wet.water.std_kg_m2),
                with_deviation(wet.downstream_kg_m2, wet.downstream_std_kg_m2),
                with_deviation(wet.tau_dn_s, wet.tau_dn_std_s),
                wet.water.source,
            )
            for wet in expected.wet
        ),
        symbols=True,
        note="A propeller row that holds some of the water already makes these too large.",
    )


def mode_table(modes: "Modes") -> Table:
    """Return the slowest torsional modes."""
    shown = range(min(SHOWN_MODES, len(modes.frequency_hz)))
    return Table(
        title="Torsional modes",
        columns=(*texts("mode"), *numbers("frequency [Hz]", "damping ratio"), *texts("moves most", "twists most")),
        rows=tuple(
            (
                str(mode + 1),
                with_deviation(float(modes.frequency_hz[mode]), float(modes.frequency_std_hz[mode])),
                plain(float(modes.damping_ratio[mode]), 3),
                modes.moves(mode),
                modes.twists(mode),
            )
            for mode in shown
        ),
        symbols=True,
        note=(
            "Deviations are those of the stated inertias and stiffnesses. Damping: losses of couplings and shafts at "
            "the frequency of the mode, the damper, and the slope of the propeller torque."
        ),
    )


def two_mass_sentence(masses: "TwoMasses") -> str:
    """Return what two masses in place of the line are, and how far they hold."""
    return (
        f"Two masses for identification, at the propeller shaft: {rounded(masses.engine_kg_m2)} and "
        f"{rounded(masses.propeller_kg_m2)} kg m² with {rounded(masses.stiffness_nm_rad / 1000.0, 3)} kN·m/rad and "
        f"{rounded(masses.damping_nm_s_rad, 3)} N·m·s/rad between them give the first mode at "
        f"{with_deviation(masses.frequency_hz, masses.frequency_std_hz)} Hz. Speed and shaft torque are within a "
        f"tenth of those of the whole line up to {plain(masses.accurate_to_hz, 1)} Hz; at the mode the shaft torque is "
        f"{plain(PERCENT * masses.gauge_error, 0)} % off."
    )


def _pair(value: float, std: float) -> str:
    return with_deviation(value, std) if std > 0.0 else rounded(value)


def _identified(row: "InertiaComparison | None") -> tuple[str, str]:
    if row is None:
        return "–", "–"
    number = with_deviation(row.identified, row.identified_std)
    if not row.independent:
        return number, ASSUMED
    return number, "–" if math.isnan(row.deviations) else plain(row.deviations, 1)


def _sources(item: "ExpectedValue") -> list[tuple[str, str, str, str]]:
    large = {name: share for name, share in item.shares.items() if share >= SMALL_SHARE}
    rows = [
        (item.name, name, rounded(item.changes[name], 2), f"{plain(PERCENT * share, 0)} %")
        for name, share in large.items()
    ]
    small = [name for name in item.shares if name not in large]
    if small:
        together = math.hypot(*(item.changes[name] for name in small))
        share = sum(item.shares[name] for name in small)
        rows.append((item.name, f"{len(small)} others", rounded(together, 2), f"{plain(PERCENT * share, 0)} %"))
    return rows

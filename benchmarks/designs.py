"""Optimised multisines beside other excitations, within the same limits and time: what spectrum and phases are worth.

Predictions for the simulated Stan Tug 1205 with its stored noise, which knows no shaft orders. Every excitation is as
strong as its limits let it be. The deviation of each number is taken over that of the thesis campaign (3.2 h of sines),
and the largest of these ratios is the *worst*, their median the *median*. Beside each stands what an earlier prototype
found, with a noise spectrum of its own. Run ``python benchmarks/designs.py``, a minute.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.design import Effort, Limits, Plan, Wish, assumed_ship, limits_from_vessel, no_worse_than
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.plan._timetable import Timetable
from shaftprint.design.planning._brief import Brief
from shaftprint.design.planning._design import best_plan
from shaftprint.design.planning._finish import plan_of_lines
from shaftprint.identify import Prior, planned_lines, planned_response, predict_accuracy
from shaftprint.identify.prediction._accuracy import Accuracy
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.vessel import load_vessel

# The simulated tug, normalised at its working point (docs/accuracy.md).
TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.320, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
CLOSED = structure("GAUGE-CLOSED")
VOLT_RPM = 251.0
# It takes 300 N m to turn the simulated engine at 1183.8 rpm without fuel, half of it proportional to the speed.
MOTORING = ((0.0, 150.0), (1183.8, 300.0), (2367.6, 450.0))
USUAL = limits_from_vessel(load_vessel("stan-tug-1205"), set_point_rpm=VOLT_RPM)
IDLE_540 = replace(USUAL, lowest_speed_rpm=540.0, motoring=MOTORING)
# Brake torque +/- 1.42 of that at the working point, whatever the speed, and nothing else but the set point.
SAME_LIMITS = replace(
    USUAL,
    lowest_speed_rpm=100.0,
    full_load=((1000.0, 2.42 * USUAL.brake_torque_nm),),
    motoring=((1000.0, 0.42 * USUAL.brake_torque_nm),),
    noise_sigmas=0.0,
    highest_frequency_hz=7.0,
    gauge=None,
)
SIGNAL_S = 630.0
SETTLE_S = 12.0
# What the prototype spent on steady levels and ramps beside the windows of two legs [s].
TWO_LEGS = Timetable(lead_s=72.2, settle_s=10.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One excitation."""

    name: str
    """What it is."""
    accuracy: Accuracy
    """What it would tell."""
    prototype: str
    """Worst and median of the prototype."""


def numbers(accuracy: Accuracy) -> dict[str, float]:
    """Return the standard deviation of every parameter and combination."""
    return {e.name: e.std for e in (*accuracy.parameters, *accuracy.combinations)}


def ratios(accuracy: Accuracy, reference: Accuracy) -> FloatArray:
    """Return deviations over those of the reference, of the numbers that both know."""
    found, other = numbers(accuracy), numbers(reference)
    return np.array([found[name] / std for name, std in other.items() if 0.0 < std < np.inf])


# ---- one speed ----


def brief_of(ship: AssumedShip, wish: Wish) -> Brief:
    """Return one leg at the working point with windows of 630 s."""
    timetable = Timetable(lead_s=0.0, settle_s=SETTLE_S)
    return Brief.of(
        ship, wish, SAME_LIMITS, STAN_TUG_NOISE, speeds=(1.0,), within_s=SIGNAL_S + SETTLE_S, priors={},
        timetable=timetable,
    )  # fmt: skip


def periodic(brief: Brief, samples: FloatArray, period_s: float) -> Plan:
    """Return the plan of a periodic signal from its samples, as strong as the limits let it be."""
    spectrum = 2.0 * np.fft.rfft(samples) / samples.size
    highest = int(SAME_LIMITS.highest_frequency_hz * period_s)
    harmonics = tuple(range(1, min(highest, spectrum.size - 1) + 1))
    own = replace(brief, harmonics=(harmonics,), period_s=period_s, periods=round(SIGNAL_S / period_s))
    return plan_of_lines(own, [spectrum[list(harmonics)]], brief.ship.values[None, :])


def with_phases(plan: Plan, brief: Brief, phases: FloatArray) -> Plan:
    """Return the lines of a plan with other phases, as strong as the limits let them be."""
    (leg,) = plan.legs
    own = replace(brief, harmonics=(leg.harmonics,))
    return plan_of_lines(own, [np.abs(leg.amplitudes) * np.exp(1j * phases)], brief.ship.values[None, :])


def schroeder(amplitudes: ComplexArray) -> FloatArray:
    """Return phases with which the frequency sweeps with the power.

    Schroeder, Synthesis of low-peak-factor signals and binary sequences with low autocorrelation, 1970, eq. 8.
    """
    power = np.abs(amplitudes) ** 2
    share = np.cumsum(power) / power.sum()
    return np.asarray(-2.0 * np.pi * np.concatenate([[0.0], np.cumsum(share)[:-1]]))


def multisine(brief: Brief, size: FloatArray, harmonics: Sequence[int]) -> Plan:
    """Return a multisine of given sizes with phases of Schroeder."""
    own = replace(brief, harmonics=(tuple(harmonics),))
    amplitudes = size * np.exp(1j * schroeder(size.astype(complex)))
    return plan_of_lines(own, [amplitudes], brief.ship.values[None, :])


def largest_amplitude(brief: Brief, frequency_hz: FloatArray) -> FloatArray:
    """Return the largest amplitude of a single sine at each frequency that the limits allow, over the speed."""
    own = replace(brief, harmonics=(tuple(range(1, frequency_hz.size + 1)),))
    amplitudes = []
    for hertz in frequency_hz:
        single = replace(own, harmonics=((1,),), period_s=1.0 / hertz)
        amplitudes.append(1.0 / single.uses(0, brief.ship.values[None, :]).largest(np.array([1.0 + 0.0j])).max())
    return np.array(amplitudes)


def of_lines(ship: AssumedShip, frequency_hz: FloatArray, amplitude: FloatArray, seconds: FloatArray) -> Accuracy:
    """Return what lines one after the other would tell."""
    lines = planned_lines(frequency_hz, noise=STAN_TUG_NOISE, amplitude=amplitude, duration_s=seconds)
    return predict_accuracy(ship.structure, lines, values=ship.by_name)


def sequential_sines(ship: AssumedShip, brief: Brief, reference: Accuracy) -> Accuracy:
    """Return five sines, each as strong as it may be, their lengths chosen for the smallest worst ratio."""
    hertz = np.array([0.03, 0.2, 0.57, 1.75, 6.0])
    amplitude = largest_amplitude(brief, hertz)

    def lengths(unknowns: FloatArray) -> FloatArray:
        share = np.exp(unknowns - unknowns.max())
        return np.asarray((SIGNAL_S - SETTLE_S * hertz.size) * share / share.sum())

    def worst(unknowns: FloatArray) -> float:
        return float(ratios(of_lines(ship, hertz, amplitude, lengths(unknowns)), reference).max())

    best = minimize(worst, np.zeros(hertz.size), method="Nelder-Mead", options={"maxiter": 400})
    return of_lines(ship, hertz, amplitude, lengths(best.x))


def chirp(ship: AssumedShip, brief: Brief, *, shaped: bool) -> Accuracy:
    """Return a logarithmic sweep, its amplitude at each frequency as large as it may be or the same everywhere."""
    hertz = np.geomspace(0.03, 7.0, 150)
    amplitude = largest_amplitude(brief, hertz)
    amplitude = amplitude if shaped else np.full_like(amplitude, amplitude.min())
    return of_lines(ship, hertz, amplitude, np.full_like(hertz, SIGNAL_S / hertz.size))


def binary_sequence(order: int, taps: tuple[int, ...]) -> FloatArray:
    """Return one period of a sequence of largest length, +1 and -1."""
    register, sequence = [1] * order, []
    for _ in range(2**order - 1):
        sequence.append(register[-1])
        bit = 0
        for tap in taps:
            bit ^= register[tap - 1]
        register = [bit, *register[:-1]]
    return 2.0 * np.array(sequence, dtype=np.float64) - 1.0


def one_speed() -> list[Row]:
    """Return all excitations at one speed, 630 s of signal, +/- 1 V, judged by the data alone with ``g`` held."""
    ship = assumed_ship(CLOSED.held_at(g=0.0), TRUTH, std={})
    reference = predict_accuracy(
        ship.structure, planned_response(load_campaign("thesis"), STAN_TUG_NOISE), values=TRUTH
    )
    known = [e for e in (*reference.parameters, *reference.combinations) if np.isfinite(e.std)]
    minimax, free = brief_of(ship, no_worse_than(known)), brief_of(ship, Wish())
    rng = np.random.default_rng(1)
    best = best_plan(minimax, Effort(restarts=6), rng)
    (leg,) = best.legs
    odd = minimax.harmonics[0]
    spaced = np.unique(2 * np.round((np.geomspace(1.0, odd[-1], 14) - 1.0) / 2.0).astype(int) + 1)
    square = [np.sign(np.sin(2.0 * np.pi * (np.arange(8192) + 0.5) / 8192))] * 2
    clocks = ((2.0, binary_sequence(6, (6, 5)), "4.0, 3.5"), (0.5, binary_sequence(7, (7, 6)), "12, 3.6"),
              (0.2, binary_sequence(8, (8, 6, 5, 4)), "20, 3.7"))  # fmt: skip
    plans = [
        ("minimax multisine", best, "1.21, 1.02"),
        ("its spectrum, phases of Schroeder", with_phases(best, minimax, schroeder(leg.amplitudes)), "2.48, 2.1"),
        ("its spectrum, random phases",
         with_phases(best, minimax, rng.uniform(0.0, 2.0 * np.pi, len(leg.harmonics))), "2.62, 2.2"),
        ("D-optimal multisine", best_plan(free, Effort(restarts=6), rng), "2.34, 0.45"),
        ("14 equal lines", multisine(minimax, np.ones(spaced.size), spaced.tolist()), "4.1, 1.06"),
        ("flat multisine", multisine(minimax, np.ones(len(odd)), odd), "8.6, 4.1"),
        ("1/sqrt(f) multisine", multisine(minimax, 1.0 / np.sqrt(odd), odd), "4.4, 1.2"),
        ("square wave, 15 s", periodic(minimax, square[0], 30.0), "5.0, 4.7"),
        ("square wave, 30 s", periodic(minimax, square[1], 60.0), "7.0, 6.7"),
        *(
            (f"PRBS, clock {clock:g} s", periodic(minimax, np.repeat(bits, 64), clock * bits.size), prototype)
            for clock, bits, prototype in clocks
        ),
    ]  # fmt: skip
    rows = [Row(name=name, accuracy=plan.predicted, prototype=prototype) for name, plan, prototype in plans]
    rows += [
        Row(name="sequential sines", accuracy=sequential_sines(ship, minimax, reference), prototype="1.36, -"),
        Row(name="chirp, shaped", accuracy=chirp(ship, minimax, shaped=True), prototype="1.98, 0.75"),
        Row(name="chirp, constant", accuracy=chirp(ship, minimax, shaped=False), prototype="5.7, 2.0"),
    ]
    print("| one speed, 630 s, +/- 1 V | worst | median | prototype: worst, median |\n|---|---|---|---|")
    for row in rows:
        share = ratios(row.accuracy, reference)
        print(f"| {row.name} | {share.max():.2f} | {np.median(share):.2f} | {row.prototype} |", flush=True)
    return rows


# ---- two speeds ----


def two_speeds() -> None:
    """Print the worst ratio of two speeds without priors to the campaign with those of the builder, over the length."""
    ship = assumed_ship(CLOSED, TRUTH, std={})
    priors = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.0285)}
    thesis = predict_accuracy(
        CLOSED, planned_response(load_campaign("thesis"), STAN_TUG_NOISE), values=TRUTH, priors=priors
    )
    wish = no_worse_than((*thesis.parameters, *thesis.combinations), but=("t_gauge",))
    slow = {rate: replace(IDLE_540, demand_rate_limit_rpm_per_s=rate) for rate in (600.0, 300.0, 100.0)}
    cases: list[tuple[str, Limits, tuple[float, float], float, str]] = [
        *(("+/- 1.0 V, 1.15 and 0.70", IDLE_540, (1.15, 0.70), m, p)
          for m, p in ((5.0, "1.87"), (8.0, "1.37"), (12.0, "1.07"), (20.0, "0.85"))),
        *(("+/- 0.6 V, 1.15 and 0.70", replace(IDLE_540, set_point_rpm=0.6 * VOLT_RPM), (1.15, 0.70), m, p)
          for m, p in ((5.0, "2.85"), (12.0, "1.60"), (20.0, "1.25"))),
        ("+/- 1.0 V, 1.15 and 0.78, idle at 600 rpm", replace(USUAL, motoring=MOTORING), (1.15, 0.78), 12.0, "1.25"),
        *((f"+/- 1.0 V, 1.15 and 0.70, {rate:g} rpm/s", limits, (1.15, 0.70), 12.0, p)
          for (rate, limits), p in zip(slow.items(), ("1.21", "1.85", "5.6"), strict=True)),
    ]  # fmt: skip
    names = ("K_p", "t_d", "v K_p / (tau_up + tau_dn)", "v K_i / (k_q - g)")
    print("\n| two speeds | min | worst | prototype | " + " | ".join(f"`{name}` over" for name in names) + " |")
    print("|---|---|---|---|" + "---|" * len(names))
    for name, limits, speeds, minutes, prototype in cases:
        brief = Brief.of(
            ship, wish, limits, STAN_TUG_NOISE, speeds=speeds, within_s=60.0 * minutes, priors={}, timetable=TWO_LEGS
        )
        plan = best_plan(brief, Effort(), np.random.default_rng(1))
        shares = " | ".join(f"{plan.ratios[one]:.2f}" for one in names)
        print(f"| {name} | {minutes:g} | {max(plan.ratios.values()):.2f} | {prototype} | {shares} |", flush=True)


def main() -> None:
    """Print both tables."""
    one_speed()
    two_speeds()


if __name__ == "__main__":
    main()

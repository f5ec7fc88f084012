"""Long chirps through a closed loop with an exact delay, solved by the method of steps: no code of the package."""

from dataclasses import replace

import numpy as np
import pytest
from numba import njit
from scipy.signal import firwin, oaconvolve
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError, SignalError
from shaftprint.identify import (
    GivenStarts,
    Settings,
    Unweighted,
    assess,
    bootstrap,
    identify,
    identify_jointly,
    profile_intervals,
)
from shaftprint.spectra import FrequencyResponse
from shaftprint.time_domain import identify_chirp, record_from_arrays, spectrum_of, spectrum_term
from shaftprint.time_domain._bands import bands_of
from shaftprint.tug import Tug
from shaftprint.vessel import load_vessel

TRUTH = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}
RATE_HZ = 50.0
# Steps of the solution for a sample of the record; the delay is a whole number of steps: 240 of 0.5 ms.
EVERY = 40
# Start and stop [s], first and last frequency [Hz] of the three parts, one right after the other as the thesis merges
# them, with rest before and after.
PARTS = ((20.0, 570.0, 0.001, 0.02), (570.0, 1120.0, 0.015, 0.27), (1120.0, 1670.0, 0.1, 3.981))
DURATION_S = 1700.0
AMPLITUDE = 0.12


def set_point(time_s):
    """Return the three chirps one after the other."""
    found = np.zeros_like(time_s)
    for start, stop, first, last in PARTS:
        inside = (time_s >= start) & (time_s < stop)
        share = (time_s[inside] - start) / (stop - start)
        octaves = np.log(last / first)
        phase = 2 * np.pi * first * (stop - start) / octaves * (np.exp(octaves * share) - 1.0)
        found[inside] = AMPLITUDE * np.sin(phase)
    return found


@njit(cache=False)
def heun(u, step_s, lag, tau, k_p, k_i, omega, zeta):
    """Integrate governor, delay of ``lag`` steps, second-order lag and shaft; return speed and torque at every step.

    dE/dt = u - n, X = K_p (u - n) + K_i E, m'' = omega^2 (X(t - t_d) - m) - 2 zeta omega m', tau n' = m - 2 n.
    """
    count = u.size
    n, m = np.zeros(count), np.zeros(count)
    given = np.zeros(count)
    integral, rate = 0.0, 0.0
    for i in range(count - 1):
        given[i] = k_p * (u[i] - n[i]) + k_i * integral
        now = given[i - lag] if i >= lag else 0.0
        then = given[i + 1 - lag] if i + 1 >= lag else 0.0
        d_integral = u[i] - n[i]
        d_m, d_rate = rate, omega * omega * (now - m[i]) - 2.0 * zeta * omega * rate
        d_n = (m[i] - 2.0 * n[i]) / tau
        n_1, m_1, rate_1 = n[i] + step_s * d_n, m[i] + step_s * d_m, rate + step_s * d_rate
        e_rate = omega * omega * (then - m_1) - 2.0 * zeta * omega * rate_1
        integral += 0.5 * step_s * (d_integral + u[i + 1] - n_1)
        m[i + 1] = m[i] + 0.5 * step_s * (d_m + rate_1)
        n[i + 1] = n[i] + 0.5 * step_s * (d_n + (m_1 - 2.0 * n_1) / tau)
        rate += 0.5 * step_s * (d_rate + e_rate)
    return n, m


def solution(truth=None):
    """Return time, set point, speed and torque of the loop at the rate of the record, from rest to rest."""
    of = TRUTH if truth is None else truth
    step = 1.0 / (RATE_HZ * EVERY)
    u = set_point(np.arange(round(DURATION_S / step)) * step)
    lag = round(of["t_d"] / step)
    assert lag >= 1
    assert abs(lag * step - of["t_d"]) < 1e-12
    n, m = heun(u, step, lag, of["tau_n"], of["K_p"], of["K_i"], of["omega_n"], of["zeta"])
    # a logger's filter, without delay and the same for all channels: jumps of the set point fall between samples too
    low_pass = firwin(20 * EVERY + 1, 0.8 / EVERY)
    sampled = [oaconvolve(values, low_pass, mode="same")[::EVERY] for values in (u, n, m)]
    return np.arange(0, u.size, EVERY) * step, *sampled


def spectral_density(frequency_hz, std, corner_hz):
    """Return the spectrum of sampled noise of first order: its mean over all frequencies is the variance."""
    pole = np.exp(-2.0 * np.pi * corner_hz / RATE_HZ)
    return std**2 * (1.0 - pole**2) / np.abs(1.0 - pole * np.exp(-2j * np.pi * frequency_hz / RATE_HZ)) ** 2


def coloured(rng, count, std, corner_hz):
    """Return noise of that spectrum."""
    shaped = np.fft.rfft(rng.standard_normal(count))
    shaped *= np.sqrt(spectral_density(np.fft.rfftfreq(count, 1.0 / RATE_HZ), std, corner_hz))
    return np.fft.irfft(shaped, count)


# Standard deviation [-] and corner [Hz] of the noise of speed, of torque, and of what both have in common.
NOISE = {"n": (0.01, 0.3), "M_s": (0.06, 3.0), "both": (0.02, 1.0)}
SHARE_OF_N = 0.3


def noise(rng, count, size):
    """Return noise of speed and torque: of different colour, and correlated."""
    both = coloured(rng, count, *NOISE["both"])
    n, m = coloured(rng, count, *NOISE["n"]), coloured(rng, count, *NOISE["M_s"])
    return size * (n + SHARE_OF_N * both), size * (m + both)


@pytest.fixture(scope="module")
def motion():
    return solution()


@pytest.fixture(scope="module")
def make_record(motion):
    """Return a maker of records between two times, with noise of a size, or other noise."""

    def make(start_s=0.0, stop_s=DURATION_S, *, size=0.0, seed=1, added=None):
        time, u, n, m = motion
        part = slice(round(start_s * RATE_HZ), round(stop_s * RATE_HZ))
        more = noise(np.random.default_rng(seed), time.size, size) if added is None else added
        outputs = {"n": (n + more[0])[part], "M_s": (m + more[1])[part]}
        return record_from_arrays("C2", {"n_set": u[part]}, outputs, rate_hz=RATE_HZ, start_s=start_s)

    return make


def fitted(record, name="CL4", **options):
    return identify_chirp(structure(name), record, rng=np.random.default_rng(5), **options)


def errors(found):
    """Return the error of each estimate, relative to the truth."""
    return {e.name: e.value / TRUTH[e.name] - 1.0 for e in found.parameters}


# ---- truth ----


@pytest.mark.slow
def test_small_noise_from_rest_to_rest_gives_the_truth(make_record):
    found = fitted(make_record(size=0.02))
    assert max(map(abs, errors(found).values())) < 2e-3
    assert found.clusters[0].stable
    assert found.reached >= 20
    for estimate in found.parameters:
        assert 1e-5 < estimate.std / estimate.value < 2e-3, estimate.name


@pytest.mark.slow
def test_estimates_are_those_of_maximum_likelihood_in_time(motion, make_record):
    """White noise of known size: weighted least squares over all samples, linear about the truth, is that estimate."""
    n = motion[2]
    std = np.array([0.001, 0.0075])
    rng = np.random.default_rng(11)
    added = rng.standard_normal((2, n.size)) * std[:, None]
    slopes, names = [], list(TRUTH)
    # the delay moves by whole steps of the solution
    for name in names:
        step = 0.004 if name == "t_d" else 0.01 * TRUTH[name]
        ahead, behind = (solution(TRUTH | {name: TRUTH[name] + sign * step})[2:] for sign in (1, -1))
        slopes.append((np.array(ahead) - np.array(behind)) / (2.0 * step) / std[:, None])
    jacobian = np.reshape(slopes, (len(names), -1))
    information = jacobian @ jacobian.T
    expected = np.array([TRUTH[name] for name in names])
    expected = expected + np.linalg.solve(information, jacobian @ (added / std[:, None]).ravel())
    found = fitted(make_record(added=added))
    estimates = {e.name: e for e in found.parameters}
    for name, value, variance in zip(names, expected, np.diag(np.linalg.inv(information)), strict=True):
        assert estimates[name].value == pytest.approx(value, rel=5e-3), name
        assert estimates[name].value == pytest.approx(value, abs=0.5 * np.sqrt(variance)), name
        assert estimates[name].std == pytest.approx(np.sqrt(variance), rel=0.05), name


@pytest.mark.slow
@pytest.mark.parametrize(("stop_s", "size"), [(1400.0, 0.002), (1500.0, 0.02)])
def test_a_record_cut_in_motion_gives_the_truth_with_transients_only(make_record, stop_s, size):
    record = make_record(270.0, stop_s, size=size)
    found, without = fitted(record), fitted(record, transients=False)
    missed, missed_without = (max(map(abs, errors(fit).values())) for fit in (found, without))
    assert missed < 5e-3
    assert missed_without > 2e-2
    assert missed_without > 5.0 * missed
    assert found.p_value > 0.05
    # where there is next to no noise beside it, the test of fit sees the leakage too
    assert size > 0.01 or without.p_value < 1e-6


def test_a_record_that_ends_before_the_lag_shows_gives_the_truth_without_noise(make_record):
    """A thousand seconds, up to 0.35 Hz only; without transients no optimum is a stable model."""
    record = make_record(270.0, 1270.0)
    assert max(map(abs, errors(fitted(record)).values())) < 1e-3
    with pytest.raises(IdentificationError, match="stable model"):
        fitted(record, transients=False)


@pytest.mark.long
def test_intervals_and_tests_are_right_over_repeats(make_record):
    """200 records of the last chirp, cut in motion, with noise drawn anew at the lines: intervals hold the truth."""
    clean = spectrum_of(make_record(1115.0, 1670.0), "n_set", ("n", "M_s"))
    cl4, rng, repeats = structure("CL4"), np.random.default_rng(21), 200
    truth = np.array([TRUTH[p.name] for p in cl4.free])
    at_truth = Settings(draw=GivenStarts(truth[None]), starts=1)

    def drawn(name):
        root = np.sqrt(0.5 * spectral_density(clean.frequency_hz, *NOISE[name]))
        return 0.3 * root * (rng.standard_normal(root.size) + 1j * rng.standard_normal(root.size))

    values, std, p_values = np.empty((repeats, truth.size)), np.empty((repeats, truth.size)), np.empty(repeats)
    for repeat in range(repeats):
        both = drawn("both")
        outputs = clean.outputs + np.stack([drawn("n") + SHARE_OF_N * both, drawn("M_s") + both])
        bands = bands_of(clean.source, outputs)
        spectrum = replace(clean, outputs=outputs, bands=bands, noise=bands.at_lines(outputs.shape[1]))
        found = identify_jointly([spectrum_term(cl4, spectrum)], rng=rng, settings=at_truth)
        values[repeat], std[repeat] = np.transpose([(e.value, e.std) for e in found.parameters])
        p_values[repeat] = found.p_value
    held = np.mean(np.abs(values - truth) < 1.96 * std, axis=0)
    assert np.all((held >= 0.88) & (held <= 0.99)), held
    assert np.all(np.abs(values.mean(axis=0) / truth - 1.0) < 0.03)
    # of 200 uniform numbers the mean scatters by 0.02, the share below 0.1 by 0.02
    assert 0.43 < p_values.mean() < 0.57
    assert 0.03 < np.mean(p_values < 0.1) < 0.17


@pytest.mark.long
@pytest.mark.parametrize(("size", "widest"), [(2e-5, 0.1), (5e-4, np.inf)])
def test_the_simulated_tug_at_small_amplitude_has_the_gauge_aware_loop(size, widest):
    """Its equations share nothing with the models; the chirp begins at rest and ends at full speed.

    With the louder noise both delays lie in one valley; an end of it must not look like knowledge of either.
    """
    vessel, thesis = load_vessel("stan-tug-1205"), load_campaign("thesis")
    (chirp,) = (c for c in thesis.chirps if c.name == "C23")
    early = chirp.model_copy(update={"start_s": 10.0, "stop_s": 560.0, "amplitude_v": 0.03})
    campaign = Campaign(name="small chirp", duration_s=560.0, offset_v=thesis.offset_v, chirps=(early,))
    truth, signals = Tug.stan_tug_1205(), simulate_signals(vessel, campaign, rate_hz=50.0)
    channels = (signals.set_point_rev_s, signals.engine_speed_rev_s, signals.shaft_torque_nm)
    u, n, m = (values / values[0] - 1.0 for values in channels)
    rng = np.random.default_rng(4)
    n, m = n + size * rng.standard_normal(u.size), m + 5.0 * size * rng.standard_normal(u.size)
    record = record_from_arrays("C23", {"n_set": u}, {"n": n, "M_s": m}, rate_hz=50.0)
    gauge = structure("GAUGE-CLOSED").held_at(g=truth.g, t_gauge=0.0)
    found = identify_chirp(gauge, record, rng=np.random.default_rng(5))
    expected = {
        "K_p": truth.proportional_gain,
        "K_i": truth.integral_gain_per_s,
        "t_d": truth.governor_delay_s,
        "t_sp": truth.set_point_latency_s,
        "omega_n": truth.natural_frequency_rad_s,
        "zeta": truth.damping_ratio,
        # 2 pi I n_s0 / M_s0 of 17.0 and 54.006 kg m2 at 5.16492 rev/s and 1725 N m, by hand
        "tau_dn": 0.3198,
        "tau_up": 1.0160,
        "k_q": 2.0,
        "c_set": 1.0,
    }
    estimates = {e.name: e for e in found.parameters}
    assert set(estimates) == set(expected)
    for name, value in expected.items():
        assert estimates[name].value == pytest.approx(value, abs=3.5 * estimates[name].std + 2e-3 * value), name
        # the valley of t_d and t_sp may end the others' intervals nowhere; these it does not touch
        if name in ("tau_dn", "k_q", "c_set"):
            assert estimates[name].std <= widest * (value + 0.02), name


# ---- what the noise is taken for ----


def test_noise_is_found_with_its_colour_and_correlation(make_record):
    """Against the spectra from which it was drawn, averaged over many bands."""
    spectrum = spectrum_of(make_record(size=1.0), "n_set", ("n", "M_s"))
    n, m, both = (spectral_density(spectrum.frequency_hz, *NOISE[name]) for name in ("n", "M_s", "both"))
    for found, true in (
        (spectrum.noise[:, 0, 0], n + SHARE_OF_N**2 * both),
        (spectrum.noise[:, 1, 1], m + both),
        (spectrum.noise[:, 0, 1], SHARE_OF_N * both),
    ):
        for part in (slice(0, 1500), slice(1500, None)):
            assert np.mean(found[part].real / true[part]) == pytest.approx(1.0, abs=0.12)
            assert np.mean(found[part].imag / true[part]) == pytest.approx(0.0, abs=0.12)


def test_fit_percent_is_that_over_time(make_record, motion):
    """The noise alone is left of the output: 100 (1 - |noise| / |output|)."""
    record = make_record(size=1.0)
    found = fitted(record)
    for place, name in enumerate(("n", "M_s")):
        output = record.outputs[name]
        left = output - motion[2 + place]
        expected = 100.0 * (1.0 - np.std(left) / np.std(output))
        assert found.fit_percent[name] == pytest.approx(expected, abs=0.3), name
        assert found.fit_ceiling[name] == pytest.approx(expected, abs=0.6), name


# ---- the rest of the machinery ----


@pytest.fixture(scope="module")
def found(make_record):
    return fitted(make_record(size=0.1))


@pytest.mark.long
def test_profiles_verdict_and_repeats_take_it(found):
    intervals = profile_intervals(found)
    for estimate in found.parameters:
        low, high = estimate.limits_95
        width = high - low
        assert intervals[estimate.name].lower == pytest.approx(low, abs=0.1 * width)
        assert intervals[estimate.name].upper == pytest.approx(high, abs=0.1 * width)
    verdict = assess(found)
    assert verdict.trustworthy, verdict.reason
    repeats = bootstrap(found, count=30, rng=np.random.default_rng(3))
    for estimate in found.parameters:
        assert repeats.estimates[estimate.name].std == pytest.approx(estimate.std, rel=0.5)
    with pytest.raises(IdentificationError, match="no frequency response"):
        _ = found.response
    assert [part.name for part in found.parts] == ["lines of record C2"]
    assert found.objective.terms[0].name == "lines of record C2"


@pytest.mark.slow
def test_sines_and_chirp_in_one_likelihood_know_the_sum_of_both(found, make_record):
    """Independent data: their information adds up, as matrices."""
    cl4, frequency = structure("CL4"), np.array([0.0044, 0.0193, 0.06, 0.178, 0.373, 0.781, 1.637, 3.433])
    exact = cl4.response(cl4.vector(TRUTH), 2j * np.pi * frequency)
    std = np.tile(0.01 * np.abs(exact), (2, 1)).T
    covariance = std[:, :, None] ** 2 * np.eye(4)
    sines = FrequencyResponse(
        frequency_hz=frequency, response=exact[:, None], covariance=covariance, inputs=("n_set",), outputs=("n", "M_s")
    )
    rng = np.random.default_rng(8)
    alone = identify(cl4, sines, rng=rng)
    together = identify_jointly([(cl4, sines), found.objective.terms[0]], rng=rng, settings=Settings(starts=10))
    information = np.linalg.inv(alone.covariance) + np.linalg.inv(found.covariance)
    np.testing.assert_allclose(
        np.sqrt(np.diag(together.covariance)), np.sqrt(np.diag(np.linalg.inv(information))), rtol=0.02
    )
    assert max(map(abs, errors(together).values())) < 1e-2


def test_the_thesis_cl2_is_rejected_where_the_ship_has_lag_and_delay(make_record):
    """CL2 is the structure of CL1, three parameters, fitted to the long chirp (thesis section 5.4)."""
    small = fitted(make_record(size=0.1), "CL1")
    assert len(small.parameters) == 3
    assert small.p_value < 1e-6
    assert fitted(make_record(size=0.1)).p_value > 0.01


def test_a_drift_is_not_taken_for_the_ship(make_record, motion):
    count = motion[0].size
    line = np.linspace(0.0, 1.0, count)
    added = [x + size * line for x, size in zip(noise(np.random.default_rng(2), count, 0.02), (0.05, 0.1), strict=True)]
    with_line = errors(fitted(make_record(added=added), drift=True))
    without = errors(fitted(make_record(added=added)))
    assert max(map(abs, with_line.values())) < 3e-3
    assert max(map(abs, without.values())) > 2.0 * max(map(abs, with_line.values()))


# ---- what cannot be fitted ----


def test_few_missing_samples_are_filled_and_many_refused(make_record):
    record = make_record(size=0.02)
    lost = record.used.copy()
    lost[40_000:40_020] = False
    assert max(map(abs, errors(fitted(replace(record, used=lost))).values())) < 5e-3
    lost[40_000:42_000] = False
    with pytest.raises(SignalError, match="without gaps, found 2000 of"):
        fitted(replace(record, used=lost))


def test_wrong_requests_are_refused(make_record):
    record = make_record(size=0.02)
    with pytest.raises(SignalError, match="expected channels e, M_s, found n_set, n, M_s"):
        fitted(record, "OL2")
    with pytest.raises(SignalError, match="at least 24 excited lines"):
        fitted(record, band_hz=(1.0, 1.01))
    with pytest.raises(IdentificationError, match="weighting MaximumLikelihood"):
        fitted(record, settings=Settings(weighting=Unweighted()))


def test_a_band_can_be_chosen(make_record):
    found = fitted(make_record(size=0.02), band_hz=(0.01, 2.0))
    frequency = found.parts[0].spectrum.frequency_hz
    assert 0.01 <= frequency[0] < 0.011
    assert 1.999 < frequency[-1] <= 2.0
    assert max(map(abs, errors(found).values())) < 2e-2

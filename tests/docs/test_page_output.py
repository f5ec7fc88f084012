"""Blocks of the pages that show no command: what a command printed is what it prints now, and equations hold."""

import re

import numpy as np
import pytest
from pages import ROOT, shown

from shaftprint.catalogue import structure
from shaftprint.clocks import Alignment, ClockMap, LoggerClock, Stretch
from shaftprint.fingerprint import ClockInfluence
from shaftprint.report.sections._clocks import clock_sentences

NUMBER = re.compile(r"(?<![\w.])[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def sentences(text):
    """Return what each line says, without its bullet."""
    return [line.strip().removeprefix("* ") for line in text.strip().splitlines()]


def shape(sentence):
    """Return a sentence with # for each of its numbers."""
    return NUMBER.sub("#", " ".join(sentence.split()))


def numbers(sentence):
    """Return the numbers of a sentence."""
    return [float(number.replace("−", "-")) for number in NUMBER.findall(sentence)]


def found(demo):
    """Return what the demo says at its end."""
    output = demo[1].stdout
    return sentences(output[output.index("What was found") :])


def test_the_readme_shows_lines_of_the_demo_in_their_order(demo):
    now = [shape(sentence) for sentence in found(demo)]
    places = [now.index(shape(sentence)) for sentence in sentences(shown("README.md"))]
    assert places == sorted(places)


def test_what_the_readme_shows_is_told_rightly():
    """The numbers are those of the whole campaign: the truth, and intervals that hold it."""
    for sentence in sentences(shown("README.md"))[1:]:
        value, *ends, true = numbers(re.sub("95 % interval|kg m2", "", sentence))
        if len(ends) == 1:
            assert abs(value - true) < 3.0 * ends[0], sentence
        else:
            assert ends[0] < value < ends[1], sentence
            assert ends[0] < true < ends[1], sentence


def test_the_start_shows_what_the_short_demo_finds(demo):
    now = {shape(sentence): numbers(sentence) for sentence in found(demo)}
    for sentence in sentences(shown("docs/start.md")):
        # the same seed; another processor rounds otherwise
        assert numbers(sentence) == pytest.approx(now[shape(sentence)], rel=5e-3), sentence


def test_the_sentences_on_the_clock_of_a_second_logger_are_those_of_the_report():
    """Made here from the numbers that the page shows, and from the truth of two loggers 0.4 s and 30 ppm apart."""
    text = " ".join(shown("docs/several-loggers.md").split())
    offset_ms, offset_std_ms, middle_s, ppm, ppm_std = numbers(text[text.index("whose clock") :])[:5]
    assert abs(offset_ms - 1e3 * (0.4 + 30e-6 * middle_s)) < 4.0 * offset_std_ms
    assert abs(ppm - 30.0) < 4.0 * ppm_std
    line = ClockMap(
        offset_s=1e-3 * offset_ms,
        drift=1e-6 * ppm,
        middle_s=middle_s,
        covariance=np.diag([(1e-3 * offset_std_ms) ** 2, (1e-6 * ppm_std) ** 2]),
    )
    alignment = Alignment(
        map=line,
        span_s=(5.0, 860.0),
        stretches=tuple(Stretch(time_s=60.0 * i, offset_s=0.4, std_s=1e-4) for i in range(14)),
        scatter=0.89,
    )
    clock = LoggerClock(
        logger="shaft.nc",
        sha256="12" * 32,
        reference="bridge.nc",
        reference_sha256="34" * 32,
        channels=("PTM_1", "PTM_4", "M_s"),
        alignment=alignment,
    )
    # 0.021 ms at 3.30 Hz are 0.025 degrees, and 0.14 of 0.15 ms
    influence = ClockInfluence(
        logger="shaft.nc",
        std_s=2.1e-5,
        moved=("M_s",),
        line="S10",
        frequency_hz=3.3,
        phase_rad=2.0 * np.pi * 3.3 * 2.1e-5,
        delay_std_s=1.5e-4,
    )
    now = clock_sentences(clock, influence).replace("\u202f", "")
    assert shape(text) == shape(now)
    assert numbers(text) == pytest.approx(numbers(now), rel=0.1)


@pytest.mark.parametrize("frequency_hz", [0.01, 0.2])
def test_the_equations_of_the_free_sailing_ship_are_those_of_its_structure(frequency_hz):
    """Solved as they stand on the page for the speed, ship's speed, thrust and load torque at a torque of 1."""
    s = 2j * np.pi * frequency_hz
    ship = structure("FREE-CORE")
    values = {"tau_dn": 0.289, "a": -0.9, "b": -0.46, "e": 4.0, "tau_u": 7.4}
    rows = {}
    for line in shown("docs/free-sailing.md").splitlines():
        name, equation = line.split()[0], re.split(r"\s{3,}", line[line.index(" ") :].strip())[0]
        rows[name] = equation
    assert set(rows) == {"thrust", "torque", "ship", "gauge"}
    starred = {"T": 0, "Q": 1, "n": 2, "v": 3}
    matrix, right = np.zeros((4, 4), dtype=complex), np.zeros(4, dtype=complex)
    for place, equation in enumerate(rows.values()):
        text = re.sub(r"d([nv])\*/dt", r"s \1*", equation)
        text = re.sub(r"(?<=[\w)]) (?=[nv]\*)|(?<=\w) (?=s )", " * ", text).replace("s n*", "s * n*")
        text = re.sub(r"\b(\w+)\* *(?=[-+=]|$)|\b(\w+)\*(?=\s)", lambda found: f"x_{found[1] or found[2]} ", text)
        left, _, rest = text.partition("=")
        for unknown in (*starred, "M_s"):
            at = {f"x_{name}": float(name == unknown) for name in (*starred, "M_s")}
            # our own page
            value = eval(f"({left}) - ({rest})", {}, values | at | {"s": s})  # noqa: S307
            if unknown == "M_s":
                right[place] = -value
            else:
                matrix[place, starred[unknown]] = value
    speed = np.linalg.solve(matrix, right)[starred["n"]]
    known = {name: value for name, value in values.items() if name in ship.names}
    assert speed == pytest.approx(ship.response(ship.vector(known), s)[0, 0], rel=1e-9)


@pytest.mark.slow
def test_the_page_of_logs_says_what_the_scan_says(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("sail", "stan-tug-1205-service", "--service", "1h", "-o", "logs").exit_code == 0
    printed = run("service", "scan", "logs/log-01.nc", "--vessel", "stan-tug-1205-service", "-o", "s.csv").output
    (told,) = re.findall(r"(?m)^> (Your logger saw .*)$", (ROOT / "docs" / "service.md").read_text(encoding="utf-8"))
    assert " ".join(printed.split()).startswith(told)

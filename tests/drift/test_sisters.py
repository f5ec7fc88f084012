"""Sister ships of a known line: who is other, by how much, and what is within building."""

from dataclasses import replace

import numpy as np
import pytest
from tests.drift.test_differ import PRIORS
from tests.drift.test_watch import FIRST, I_ACTION, P_ACTION, QUARTER, doubted, made
from tests.known_fits import TRUTH, fitted, taken

from shaftprint.drift import differ, history_of, judge_sisters
from shaftprint.drift._causes import CAUSES
from shaftprint.drift._class_numbers import Sister, sister_of
from shaftprint.drift._dated import DatedTest, Event
from shaftprint.drift._discoveries import discoveries
from shaftprint.drift._sister_words import sister_sentences
from shaftprint.fingerprint._vessel_fields import BEHIND
from shaftprint.identify import Settings

INJECTION = "injection or turbocharger"
GOVERNOR = "proportional gain of the governor"
# Torque for the same rack of eight ships, which has a mean of zero and a deviation of one per cent.
BUILT = 0.01 * np.array([-1.5, -1.0, -0.5, -0.3, 0.3, 0.5, 1.0, 1.5])
BUILT /= BUILT.std(ddof=1) / 0.01


@pytest.fixture(scope="module")
def base():
    return taken(fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=20, priors=PRIORS)))


def ship(base, name, number, count=1, **factors):
    tests = [
        DatedTest(name=f"{at}", at=FIRST + at * QUARTER, fingerprint=made(100 * number + at, base, **factors))
        for at in range(count)
    ]
    return Sister(name=name, tests=tuple(tests))


def injected(base, shares, **odd):
    """Return ships that differ by their injection, the first of them by more."""
    ships = []
    for number, share in enumerate(shares):
        factors = {P_ACTION: float(np.exp(share)), I_ACTION: float(np.exp(share))}
        more = odd if number == 0 else {}
        ships.append(
            ship(
                base,
                f"ship {number}",
                number,
                **{name: factors.get(name, 1.0) * more.get(name, 1.0) for name in factors | more},
            )
        )
    return ships


def spread(finding, name):
    return next(one for one in finding.causes if one.cause.name == name)


def test_discoveries_are_those_of_a_worked_example():
    """Fifteen p-values of Benjamini and Hochberg (1995), section 4.1: at 5 % the first four count."""
    p_values = [0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000]  # fmt: skip
    assert discoveries(p_values, 0.05) == (0, 1, 2, 3)
    assert discoveries(p_values[::-1], 0.05) == (11, 12, 13, 14)
    # the second is below its limit, so that the first counts with it
    assert discoveries([0.04, 0.049], 0.05) == (0, 1)
    assert discoveries([0.2, 0.5], 0.05) == ()


def test_ships_that_are_alike_have_no_odd_one(base):
    finding = judge_sisters([ship(base, f"ship {number}", number) for number in range(5)])
    assert finding.odd == ()
    assert all(one.std == 0.0 for one in finding.causes)
    assert sister_sentences(finding) == ("No: 5 ships differ by no more than chance and building.",)


def test_what_is_within_building_is_no_change(base):
    """Two of these ships, taken as two tests of one, have changed; among sisters they are usual ones."""
    ships = injected(base, BUILT)
    first, last = (ships[at].tests[0].fingerprint for at in (0, -1))
    assert differ(first, last).changes[0].best.cause.name == INJECTION
    finding = judge_sisters(ships)
    assert finding.odd == ()
    injection = spread(finding, INJECTION)
    # a ship that is tested well keeps its size
    sizes = [one.size for one in injection.ships]
    assert sizes == pytest.approx(np.expm1(BUILT).tolist(), abs=2e-4)
    assert all(0.5 < one.shrunk / one.size < 1.0 for one in injection.ships)


def test_a_test_that_its_verdict_doubts_leaves_its_class_as_it_is(base):
    """The gauge of one ship was off in its second test; its first one stands for it, and all numbers are judged."""
    ships = injected(base, BUILT)
    sound = judge_sisters(ships)
    wild = DatedTest(
        name="off", at=FIRST + QUARTER, fingerprint=doubted(made(999, base, **{P_ACTION: 1.4, "K_Q": 0.8}))
    )
    ships[3] = replace(ships[3], tests=(*ships[3].tests, wild))
    finding = judge_sisters(ships)
    assert finding.odd == ()
    assert finding.names == sound.names
    assert list(finding.left_out) == ["off"]
    sizes, without = ([one.size for one in spread(each, INJECTION).ships] for each in (finding, sound))
    assert sizes == pytest.approx(without, abs=2e-4)


def test_the_odd_ship_is_named_with_its_cause_and_size(base):
    finding = judge_sisters(injected(base, BUILT[[3, 0, 1, 2, 4, 5, 6, 7]], **{P_ACTION: 0.93}))
    (odd,) = finding.odd
    assert odd.name == "ship 0"
    best = odd.change.best
    assert best.cause.name == GOVERNOR
    assert best.size == pytest.approx(-0.07, abs=0.006)
    # how much sisters differ as built is in the deviation: a pair of these tests knows it to a tenth of that
    assert best.std > 0.002
    sentences = sister_sentences(finding)
    assert sentences[0] == "Yes: 1 of 8 ships."
    assert sentences[1].startswith("ship 0 against its sisters: a lower proportional gain of the governor, by ")
    gain = next(one for one in finding.numbers if one.name == P_ACTION)
    assert gain.ships[0].value == pytest.approx(0.93 * np.exp(BUILT[3]) * base.quantity(P_ACTION).value, rel=1e-3)
    assert gain.ships[0].value < gain.ships[0].shrunk < gain.mean


def test_two_odd_ships_do_not_hide_each_other(base):
    ships = injected(base, BUILT[[3, 0, 1, 2, 4, 5, 6, 7]], **{P_ACTION: 0.93})
    ships[4] = ship(base, "ship 4", 9, omega_n=0.9)
    finding = judge_sisters(ships)
    assert {one.name: one.change.best.cause.name for one in finding.odd} == {
        "ship 0": GOVERNOR,
        "ship 4": "fuel actuator",
    }


def test_ships_that_differ_twice_as_much_have_twice_the_spread(base):
    """A spread of the injection alone, of which the tests know each size to a fifth of a per cent."""
    once, twice = (spread(judge_sisters(injected(base, factor * BUILT)), INJECTION).std for factor in (2.0, 4.0))
    assert twice / once == pytest.approx(2.0, rel=0.05)


def test_more_tests_of_a_ship_know_it_better(base):
    one, four = (judge_sisters([ship(base, f"s{at}", at, count) for at in range(4)]) for count in (1, 4))
    before, after = (spread(finding, GOVERNOR).ships[0].std for finding in (one, four))
    # the scale of its gauge is the same in all tests, and moves this direction little
    assert after / before == pytest.approx(0.5, abs=0.02)


def wrong_by(share, prior):
    """Return the prior of an inertia whose drawing is known that many times worse."""
    sources = {name: part * (share if name == "TVC" else 1.0) for name, part in prior.sources.items()}
    return replace(prior, std=float(np.linalg.norm(list(sources.values()))), sources=sources)


def test_pieces_ahead_of_the_gauge_are_not_taken_for_a_governor(base):
    """An inertia that is 1 % heavier than its sisters' is two deviations; what a test shows of it are lower gains."""
    loading, prior = base.joint.loadings["TVC"], base.priors["tau_up"]
    heavier = 0.01 / (prior.sources["TVC"] / prior.mean)
    # estimates of the heavier line, less what the drawing pulls
    shown = {
        name: 1.0 - heavier * change / base.quantity(name).value
        for name, change in zip(base.joint.names, loading, strict=True)
        if name in (P_ACTION, I_ACTION)
    }
    assert all(abs(factor - 1.0) > 0.003 for factor in shown.values())
    tolerances = dict.fromkeys(CAUSES, 0.0001)
    ships = [ship(base, f"ship {number}", number, **(shown if number == 0 else {})) for number in range(8)]
    assert judge_sisters(ships, tolerances=tolerances).odd == ()
    twice = {name: 1.0 + 3.0 * (factor - 1.0) for name, factor in shown.items()}
    ships = [ship(base, f"ship {number}", number, **(twice if number == 0 else {})) for number in range(8)]
    assert judge_sisters(ships, tolerances=tolerances).odd


def test_an_error_that_all_ships_share_moves_none_against_the_others(base):
    """The drawing of a class may be as wrong as it likes: all of its ships are off by the same."""
    drawn = [name for name in base.joint.loadings if name not in BEHIND]
    assert drawn

    def stated(share):
        loadings = {name: [share * one for one in base.joint.loadings[name]] for name in drawn}
        joint = base.joint.model_copy(update={"loadings": base.joint.loadings | loadings})
        priors = base.priors | {"tau_up": wrong_by(share, base.priors["tau_up"])}
        finding = judge_sisters(injected(base.model_copy(update={"joint": joint, "priors": priors}), BUILT))
        return [(one.cause.name, each.size, each.std) for one in finding.causes for each in one.ships]

    for (name, *sizes), (_, *expected) in zip(stated(1e3), stated(1.0), strict=True):
        assert sizes == pytest.approx(expected, rel=1e-5, abs=1e-12), name


def test_three_ships_are_no_class(base):
    finding = judge_sisters([ship(base, f"ship {number}", number) for number in range(3)])
    assert sister_sentences(finding) == (
        "It cannot be told: expected 4 ships with tests that can be judged or more, found 3.",
    )


def test_tests_from_before_the_last_work_do_not_stand_for_a_ship(base):
    history = history_of({f"t{place}": made(place, base) for place in range(6)})
    assert [test.name for test in sister_of("A", history).tests] == ["t3", "t4", "t5"]
    docked = replace(history, events=(Event(kind="docking", at=FIRST + 3.5 * QUARTER),))
    assert [test.name for test in sister_of("A", docked).tests] == ["t4", "t5"]
    late = replace(history, events=(Event(kind="docking", at=FIRST + 9 * QUARTER),))
    assert [test.name for test in sister_of("A", late).tests] == ["t5"]


def test_tolerances_that_the_builder_knows_are_not_told_from_the_ships(base):
    """Ships that are alike have no spread; with 2 % known it is 2 %. Those 3 % apart are odd where 1 % is known."""
    injection = next(cause for cause in CAUSES if cause.name == INJECTION)
    alike = [ship(base, f"ship {number}", number) for number in range(5)]
    assert spread(judge_sisters(alike, tolerances={injection: 0.02}), INJECTION).std == pytest.approx(0.02)
    # the others are known as they usually are
    assert spread(judge_sisters(alike, tolerances={injection: 0.02}), GOVERNOR).std == pytest.approx(0.005)
    assert judge_sisters(injected(base, 3.0 * BUILT), tolerances={injection: 0.03}).odd == ()
    assert judge_sisters(injected(base, 3.0 * BUILT), tolerances={injection: 0.01}).odd


def test_tolerances_are_stated_of_every_cause():
    assert all(0.0 < cause.tolerance < 0.05 for cause in CAUSES)

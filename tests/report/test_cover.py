"""The superintendent's questions: each answer against a fingerprint that calls for it."""

import re
from dataclasses import replace
from datetime import datetime
from types import SimpleNamespace
from typing import get_args

import pytest

from shaftprint.fingerprint import ShipIdentity
from shaftprint.identify import Estimate
from shaftprint.reasons import Reason, ReasonKind
from shaftprint.report.sections._results import summary_section
from shaftprint.report.sections.first_page._cover_of import cover_of
from shaftprint.vessel import load_vessel


def answers(fingerprint, validations=()):
    return {card.question: card for card in cover_of(fingerprint, validations).cards}


def with_physical(fingerprint, name, **changes):
    plain = {"interval_95": None, "interval_open": (False, False), **changes}
    changed = [replace(q, **plain) if q.name == name else q for q in fingerprint.physical]
    return fingerprint.model_copy(update={"physical": tuple(changed)})


def with_verdict(fingerprint, **changes):
    return fingerprint.model_copy(update={"verdict": replace(fingerprint.verdict, **changes)})


INERTIA = "Is the inertia of propeller and shaft that of the vessel file?"
GAUGE = "Is the torque gauge in order?"
HUNTING = "Does the engine hold its speed without hunting?"
PROPELLER = "Does the propeller take the torque that it should?"
USABLE = "Can the result be used?"
PREDICTS = "Does the model predict what it has not seen?"


@pytest.mark.parametrize(
    ("value", "state"), [(17.0, "fine"), (20.0, "fine"), (21.5, "look"), (25.0, "bad"), (11.0, "bad")]
)
def test_an_inertia_is_held_against_both_deviations(fingerprint, value, state):
    """17 +/- 1.6 of the vessel file and 0.5 measured: 1.68 together, so that 20 is 1.8 and 21.5 is 2.7 away."""
    found = with_physical(fingerprint, "I_dn", value=value, std=0.5, expected=17.0, expected_std=1.6)
    assert answers(found)[INERTIA].state == state
    # a vessel file from a card has estimated it: nothing was calculated
    assert "in the vessel file" in answers(found)[INERTIA].sentence
    assert "calculation" not in answers(found)[INERTIA].sentence


def test_an_inertia_names_the_source_that_the_vessel_file_states(fingerprint):
    """An estimate from the ship's card is no torsional vibration calculation."""
    told = {}
    for source in ("estimated", "table"):
        rows = {
            "flywheel": ("upstream", "assumed"),
            "propeller": ("downstream", source),
            "water": ("downstream", source),
        }
        fields = {f"inertia.{name}.gauge": gauge for name, (gauge, _) in rows.items()}
        fields |= {f"inertia.{name}.source": of for name, (_, of) in rows.items()}
        told[source] = answers(fingerprint.model_copy(update={"vessel_fields": fields}))[INERTIA].sentence
    assert told["estimated"].endswith("(estimated).")
    assert "torsional" not in told["estimated"]
    assert told["table"].endswith("(from a table).")


def test_a_torque_coefficient_says_what_it_means_for_power(fingerprint):
    """0.0525 for 0.05 is 5 % more at one speed; 4 % measured and 3 % in the file are 1.05 times 5 % together."""
    found = with_physical(fingerprint, "K_Q", value=0.0525, std=0.0021, expected=0.05, expected_std=0.0015)
    told = answers(found)["Does the propeller take the torque that it should?"].sentence
    assert "0.0525 ± 0.0021, in the vessel file 0.0500 ± 0.0015." in told
    assert told.endswith("5.0 ± 5.2 % more torque and power, and about as much more fuel.")


@pytest.mark.parametrize(
    ("value", "state"),
    [(0.05, "fine"), (0.043, "fine"), (0.058, "fine"), (0.0335, "look"), (0.0305, "look"), (0.066, "look")],
)
def test_a_torque_of_another_size_is_worth_a_look_whatever_a_guess_is_known_to(fingerprint, value, state):
    """A series is known to 15 %: 0.0305 for 0.05 is 2.6 of that, and no weather and no fouling."""
    found = with_physical(fingerprint, "K_Q", value=value, std=0.01 * value, expected=0.05, expected_std=0.0075)
    card = answers(found)[PROPELLER]
    assert card.state == state
    asked = ("diameter", "pitch", "gear ratio", "scale of the torque", "this ship")
    assert all(one in card.action for one in asked) == (state == "look")


@pytest.mark.parametrize(
    ("zero", "std", "state"), [(0.3, 0.2, "fine"), (-5.0, 0.5, "look"), (1.0, 3.0, "open"), (-1.9, 0.5, "open")]
)
def test_the_zero_of_the_gauge(fingerprint, zero, std, state):
    found = with_physical(fingerprint, "gauge zero share", value=zero, std=std)
    assert answers(found)[GAUGE].state == state


@pytest.mark.parametrize(("loop", "state"), [("ample", "fine"), ("small", "look"), ("unstable", "bad")])
def test_the_loop(fingerprint, loop, state):
    found = answers(with_verdict(fingerprint, loop=loop, trustworthy=True, not_trusted={}))[HUNTING]
    assert found.state == state
    assert ("usual" in found.sentence) == (loop != "unstable")


def test_a_structure_without_feedback_is_not_asked_about_hunting(fingerprint):
    assert HUNTING not in answers(with_verdict(fingerprint, loop=None))


def test_a_fit_that_is_not_trustworthy_answers_nothing_else(fingerprint):
    few = Reason(kind="too few data", sentence="Too few lines are good.")
    found = with_verdict(fingerprint, trustworthy=False, reason=few.sentence, reasons=(few,), loop="ample")
    cover = cover_of(found)
    assert cover.state == "bad"
    assert cover.headline.startswith("The test cannot be used")
    told = answers(found)
    assert told[USABLE].sentence == "Too few of the test frequencies could be measured well."
    assert told[USABLE].action.startswith("Repeat the test with larger moves")
    assert cover.known.startswith("0 of ")
    assert {told[question].state for question in (HUNTING, INERTIA, GAUGE)} == {"open"}


def test_without_records_nothing_is_predicted(fingerprint):
    assert answers(fingerprint)[PREDICTS].state == "open"


def test_many_lines_left_out_are_worth_a_look(fingerprint):
    conditions = fingerprint.conditions.model_copy(
        update={"lines_used": ("S1", "S2"), "lines_left_out": {"S3": "no signal", "S4": "aliased"}}
    )
    quality = fingerprint.quality.model_copy(update={"remarks": (), "repairs": {"M_s: outlier": 1}})
    found = fingerprint.model_copy(update={"conditions": conditions, "quality": quality})
    card = answers(found)["Were the measurements good?"]
    assert card.state == "look"
    assert card.sentence == ("2 of 4 test frequencies were left out of the fit, 1 place was repaired.")
    assert "Data quality" in card.action


def test_one_remark_is_said_more_are_counted_and_all_stand_among_the_findings(fingerprint):
    remarks = ("channel M_s reaches 1.02 of its range.", "channel n_e has two gaps.")
    said = {}
    for count in (1, 2):
        quality = fingerprint.quality.model_copy(update={"remarks": remarks[:count], "repairs": {"M_s: outlier": 156}})
        remarked = fingerprint.model_copy(update={"quality": quality})
        said[count] = answers(remarked)["Were the measurements good?"]
        assert said[count].state == "look"
        assert summary_section(SimpleNamespace(fingerprint=remarked)).points[-count:] == remarks[:count]
    one, two = said[1], said[2]
    assert one.sentence.endswith("places were repaired. One remark: channel M_s reaches 1.02 of its range.")
    assert one.action.endswith("Mend the cause: a sensor, its wiring, or the test.")
    assert two.sentence.endswith("156 places were repaired. There are 2 remarks on the signals.")
    assert "Findings" in two.action


def test_every_point_that_is_not_fine_says_what_to_do(fingerprint):
    """Over all reasons that a verdict may have, loops, gauges and propellers, with and without an earlier test."""
    for kind in get_args(ReasonKind):
        for trustworthy in (True, False):
            reason = Reason(kind=kind, sentence="GAUGE-CLOSED misses S3 of M_s.", where="M_s")
            doubted = with_verdict(fingerprint, trustworthy=trustworthy, reasons=(reason,), loop="small")
            doubted = with_physical(doubted, "K_Q", value=0.03, std=0.001, expected=0.0494, expected_std=None)
            cover = cover_of(doubted, previous=fingerprint)
            judged = [card for card in cover.cards if card.word != "Not judged"]
            assert not [card.question for card in judged if (card.state == "fine") == bool(card.action)]
            assert len(judged) == len(cover.cards) if trustworthy else len(judged) == 3
            words = " ".join(f"{card.question} {card.sentence} {card.action}" for card in cover.cards)
            assert not re.search(r"GAUGE-|\bS\d|M_s|I_dn|K_Q|\blines\b", words), words


def test_what_contradicts_the_vessel_file_is_on_the_first_page(fingerprint):
    """An inertia upstream 12 deviations from the calculated one, of which no question of its own asks."""
    question = "Does all else agree with the vessel file?"
    found = with_verdict(fingerprint, trustworthy=True, not_trusted={})
    assert question not in answers(with_physical(found, "I_up", value=54.0, std=1.0, expected=54.0, expected_std=1.0))
    card = answers(with_physical(found, "I_up", value=71.0, std=1.0, expected=54.0, expected_std=1.0))[question]
    assert card.state == "look"
    assert "71.0 kg m² (69.0 to 73.0)" in card.sentence


def test_numbers_have_two_digits_of_their_interval(fingerprint):
    """By hand: half an interval of 2.85 ms leaves tenths of milliseconds, one of 0.06 thousandths, one of 323 tens."""
    delay = Estimate(name="t_d + t_sp", unit="s", value=0.1216, std=0.002, interval_95=(0.1197, 0.1254))
    margin = Estimate(name="gain margin", unit="-", value=1.5382, std=0.03, interval_95=(1.5241, 1.6462))
    inertia = Estimate(name="I_up", unit="kg m2", value=738.2, std=161.0, interval_95=(415.3, 1061.2))
    numbers = {"parameters": (), "combinations": (delay,), "margins": (margin,), "physical": (inertia,)}
    made = fingerprint.model_copy(update=numbers)
    (table,) = cover_of(made).tables
    assert [row[1:3] for row in table.rows] == [
        ("740 kg m²", "420 to 1\u202f060"),
        ("121.6 ms", "119.7 to 125.4"),
        ("1.538", "1.524 to 1.646"),
    ]


def test_date_and_place_are_facts_of_the_first_page(fingerprint):
    stated = {"tested_at": datetime.fromisoformat("2026-03-13T14:05"), "place": "Quay 12"}
    told = fingerprint.model_copy(update={"conditions": fingerprint.conditions.model_copy(update=stated)})
    facts = dict(cover_of(told).facts)
    assert (facts["Tested"], facts["Place"]) == ("2026-03-13 14:05", "Quay 12")
    # the test stands in the title
    assert set(facts) == {"Tested", "Place", "Working point"}
    # what nobody stated is left out
    assert set(dict(cover_of(fingerprint).facts)) & {"Tested", "Place"} == set()


def test_ship_and_water_are_facts_of_the_first_page_where_they_are_stated(fingerprint):
    ship = ShipIdentity(name="Meander", imo_number=9074729, line="port")
    stated = {"tested_at": datetime.fromisoformat("2026-03-13T14:05+01:00"), "ship": ship, "draught_m": 1.8}
    told = fingerprint.model_copy(update={"conditions": fingerprint.conditions.model_copy(update=stated)})
    facts = dict(cover_of(told).facts)
    assert facts["Ship"] == "Meander, port, IMO 9074729"
    assert facts["Tested"] == "2026-03-13 14:05 +01:00"
    assert facts["Draught"] == "1.80 m"
    assert "Depth" not in facts


def test_an_earlier_test_is_compared_in_the_headline(fingerprint):
    earlier = with_verdict(with_physical(fingerprint, "I_dn", value=12.0), trustworthy=True)
    later = with_verdict(fingerprint, trustworthy=True)
    cover = cover_of(later, previous=earlier)
    assert cover.change.startswith(
        "Has anything changed since 2026-01-02? Yes: more inertia behind the torque gauge, by "
    )
    same = cover_of(later, previous=later)
    assert "? No: " in same.change
    doubtful = cover_of(later, previous=with_verdict(earlier, trustworthy=False))
    assert "It cannot be told: the earlier test is not trustworthy." in doubtful.change


def test_the_headline_counts_what_is_worth_a_look(fingerprint):
    good = with_verdict(fingerprint, loop="ample", trustworthy=True, trusted=("k_q",), not_trusted={}, reasons=())
    good = with_physical(good, "K_Q", value=0.049, std=0.001, expected=0.0494)
    good = with_physical(good, "I_dn", value=17.0, std=0.5, expected=17.0, expected_std=1.6)
    good = with_physical(good, "gauge zero share", value=0.0, std=0.1)
    quality = good.quality.model_copy(update={"remarks": ()})
    conditions = good.conditions.model_copy(update={"lines_left_out": {}})
    good = good.model_copy(update={"quality": quality, "conditions": conditions})
    assert cover_of(good).headline == "The test can be used, and all that it can tell is fine"
    small = with_verdict(good, loop="small")
    assert cover_of(small).headline == "The test can be used; one point is worth a look"
    both = with_physical(small, "I_dn", value=30.0, std=0.5)
    assert cover_of(both).headline == "The test can be used; one point is not fine"


@pytest.mark.parametrize(("value", "state"), [(0.0494, "fine"), (0.051, "fine"), (0.035, "look")])
def test_a_torque_coefficient_that_is_off_is_on_the_first_page(fingerprint, value, state):
    """0.001 measured beside 0.0494: 0.051 is 1.6 deviations away, 0.035 is 14."""
    found = with_verdict(fingerprint, trustworthy=True, not_trusted={})
    found = with_physical(found, "K_Q", value=value, std=0.001, expected=0.0494, expected_std=None)
    assert answers(found)[PROPELLER].state == state
    (table,) = cover_of(found).tables
    (row,) = [row for row in table.rows if row[0] == "Torque coefficient of the propeller"]
    assert ("(!)" in row[-1]) == (state == "look")


def test_seven_of_sixteen_numbers_are_worth_a_look(fingerprint):
    names = [f"number {i}" for i in range(16)]
    few = with_verdict(
        fingerprint,
        trustworthy=True,
        trusted=tuple(names[:7]),
        not_trusted=dict.fromkeys(names[7:], "vague"),
        reasons=(),
    )
    card = answers(few)[USABLE]
    assert card.state == "look"
    assert "7 of 16 numbers" in card.sentence


def test_there_is_no_room_to_spare_where_the_scale_of_the_gauge_is_in_doubt(fingerprint):
    """Times 2 in the vessel file: the gain margin 1.6 becomes 2.04, and must not be called fine."""
    scale = Reason(kind="gauge scale", sentence="The scale of the torque gauge is in doubt.", where="M_s")
    doubt = "it depends on the scale of the torque gauge"
    found = with_verdict(
        fingerprint, trustworthy=True, loop="ample", not_trusted={"gain margin": doubt, "I_dn": doubt}, reasons=(scale,)
    )
    told = answers(found)
    assert told[USABLE].state == "look"
    assert "The scale of the torque gauge is in doubt." in told[USABLE].sentence
    assert told[USABLE].action.startswith("Calibrate the torque gauge")
    assert cover_of(found).headline.startswith("The test can be used in part; ")
    assert told[HUNTING].state == told[INERTIA].state == "open"
    assert told[HUNTING].sentence.startswith(
        "It cannot be told: the gain margin depends on the scale of the torque gauge."
    )


def test_power_stands_beside_the_torque(fingerprint):
    """2 pi n / (60 i) M of the fingerprint's own working point, with the deviation of the torque."""
    conditions = fingerprint.conditions
    speed = replace(conditions.engine_speed, value=1146.0)
    torque = replace(conditions.shaft_torque, value=1910.0, std=20.0)
    told = fingerprint.model_copy(
        update={"conditions": conditions.model_copy(update={"engine_speed": speed, "shaft_torque": torque})}
    )
    # 300 rpm behind the gear of 3.82 are 31.416 rad/s
    point = dict(cover_of(told, vessel=load_vessel("stan-tug-1205")).facts)["Working point"]
    assert point == "1\u202f146 rpm engine speed, 1\u202f910 N·m shaft torque, 60.00 ± 0.63 kW"
    assert "kW" not in dict(cover_of(told).facts)["Working point"]


SHAFT = Reason(
    kind="speed scale",
    sentence="The speed is in doubt: it seems to be 5.2 times the true one, 5824 rpm where 1120 rpm are expected; that "
    'is the gear ratio of 5.2: write shaft = "engine" for n_e.',
    where="n_e",
)


def test_a_refused_test_has_the_cause_of_the_verdict_and_no_other_answer(fingerprint, vessel):
    """A pick-up of the engine that is said to be on the propeller shaft: its pulses are right, and so is the gauge."""
    found = with_verdict(fingerprint, trustworthy=False, reason=SHAFT.sentence, reasons=(SHAFT,), trusted=())
    found = with_physical(found, "K_Q", value=0.0018, std=0.0001, expected=0.0494, expected_std=None)
    cover = cover_of(found, vessel=vessel)
    told = {card.question: card for card in cover.cards}
    assert told[USABLE].action == 'That is the gear ratio of 5.2: write shaft = "engine" for n_e.'
    assert "pulses" not in f"{told[USABLE].sentence} {told[USABLE].action}"
    for question in (HUNTING, INERTIA, PROPELLER, GAUGE, PREDICTS):
        assert told[question].word == "Not judged"
        assert not told[question].action
    assert not cover.tables
    words = " ".join(f"{card.sentence} {card.action}" for card in cover.cards)
    assert "longer test" not in words
    assert "torque and power" not in words
    (point,) = [value for name, value in cover.facts if name == "Working point"]
    assert "kW" not in point
    assert point.endswith("as recorded; in doubt")


def test_the_headline_says_that_gains_and_margins_cannot_be_used(fingerprint):
    """Twelve minutes in a seaway: the speed and one inertia are known, governor and margins are not."""
    poorly = {"K_p": 14, "K_i": 12, "gain margin": 11, "phase margin": 20, "delay margin": 31}
    trusted = ("k_q", "I_dn", "K_Q", "n_0")
    found = with_verdict(
        fingerprint,
        trustworthy=True,
        reasons=(),
        trusted=trusted,
        not_trusted={name: f"it is known to {share} % only" for name, share in poorly.items()},
        reason="The fit can be trusted: GAUGE-CLOSED explains 27 good spectral lines of 114 within their noise.",
    )
    assert found.verdict.words == "trustworthy, but not governor gains and margins"
    cover = cover_of(found)
    assert cover.headline.startswith("The test can be used in part")
    assert cover.known == (
        "4 of 9 numbers are known. Inertia and propeller can be used; governor gains "
        "(known to 14 and 12 %) and margins (known to 11, 20 and 31 %) cannot."
    )
    told = answers(found)
    assert told[USABLE].state == "look"
    assert "27 of 114 in the fit stand clear of the noise." in told["Were the measurements good?"].sentence
    assert told["Were the measurements good?"].state == "look"
    (table,) = cover.tables
    marked = [row[0] for row in table.rows if "not to be used" in row[0]]
    assert [re.search(r"known to (\d+) %", words)[1] for words in marked] == ["14", "12", "11", "20", "31"]


def test_a_longer_test_is_no_advice_where_a_scale_is_wrong(fingerprint):
    doubt = "it depends on the scale of the torque gauge"
    reason = Reason(kind="gauge scale", sentence="The gauge shows half.")
    found = with_verdict(fingerprint, trustworthy=True, reasons=(reason,), not_trusted={"K_Q": doubt, "I_dn": doubt})
    for question in (PROPELLER, INERTIA):
        assert answers(found)[question].action.startswith("Do what the first answer says")
        assert "%" not in answers(found)[question].sentence


def test_an_inertia_of_the_vessel_file_is_told_at_its_shaft(fingerprint):
    """By hand: 20 and 8.318 kg m2 at the engine are 28.318 there and 765.7 behind a gear of 5.2."""
    rows = {"engine": 20.0, "damper": 8.318}
    fields = {f"inertia.{name}.inertia_kg_m2": value for name, value in rows.items()}
    fields |= {
        f"inertia.{name}.{key}": word for name in rows for key, word in (("shaft", "engine"), ("gauge", "upstream"))
    }
    found = fingerprint.model_copy(update={"vessel_fields": fields | {"gearbox.ratio": 5.2}})
    (table,) = cover_of(found).tables
    assert "before the gauge: 28.3 kg m² at the engine shaft, times 5.2² at the propeller shaft." in table.note

"""One recording with its vessel and campaign, and everything that is identified from it.

What ``shaftprint identify`` does, as a verb: ``run`` gives a ``Survey``, from which reports, tables and files are made.
The single steps are verbs too: ``measure``, ``fit``, ``survey_of``. Numbers in a survey have the units and signs of the
rooms that they come from.
"""

from shaftprint.survey._assumed_noise import (
    NOISE_SPREAD,
    RECORDED_SPREAD,
    AssumedNoise,
    assumed_noise,
    continued_below,
    noise_of_unknown_ship,
)
from shaftprint.survey._both_shafts import SurveyOfBoth, load_trials_of_both, run_both
from shaftprint.survey._contradiction import contradiction
from shaftprint.survey._everything import of_joint_fit, with_everything
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.survey._fits import comparisons_of, fit, priors_of, stated_working_point
from shaftprint.survey._legs import LegMeasurement, LegTest, leg_pairs, leg_tests, legs_of, structure_at
from shaftprint.survey._legs_apart import LegAlone, apart_reasons, legs_alone
from shaftprint.survey._limit_hints import hints_of
from shaftprint.survey._limits import with_limits
from shaftprint.survey._line_with_limits import expect_limitable, line_with_limits
from shaftprint.survey._measurement import Measurement, measure, of_legs, pairs_of, response_of, responses_of
from shaftprint.survey._noise import noise_at_speeds, noise_of_further
from shaftprint.survey._of_vessel import at_speeds, default_structure, expect_one_speed, of_vessel
from shaftprint.survey._progress import SILENT, Progress, Silent
from shaftprint.survey._ship_numbers import ship_numbers
from shaftprint.survey._survey import SettingsOf, Survey, fingerprint_of, judged, run, settings_by_name, survey_of
from shaftprint.survey._thesis_mode import SET_POINT_OFF, ThesisMode
from shaftprint.survey._thesis_way import GAUGE, line_selections, set_point_scaled, thesis_way, weighted_fits
from shaftprint.survey._trial import Trial, load_trial, settings_text
from shaftprint.survey._validation_apart import limited_model, limits_of, validated_apart, with_validation
from shaftprint.survey._validations import failed_steps, validations_of, validations_with_limits
from shaftprint.survey._wash import Wash, wash_on, wash_sentences

__all__ = [
    "GAUGE",
    "NOISE_SPREAD",
    "RECORDED_SPREAD",
    "SET_POINT_OFF",
    "SILENT",
    "AssumedNoise",
    "LegAlone",
    "LegMeasurement",
    "LegTest",
    "Measurement",
    "Progress",
    "SettingsOf",
    "Silent",
    "Survey",
    "SurveyOfBoth",
    "ThesisMode",
    "Trial",
    "Wash",
    "apart_reasons",
    "assumed_noise",
    "at_speeds",
    "comparisons_of",
    "continued_below",
    "contradiction",
    "default_structure",
    "expect_limitable",
    "expect_one_speed",
    "expected_of_ship",
    "failed_steps",
    "fingerprint_of",
    "fit",
    "hints_of",
    "judged",
    "leg_pairs",
    "leg_tests",
    "legs_alone",
    "legs_of",
    "limited_model",
    "limits_of",
    "line_selections",
    "line_with_limits",
    "load_trial",
    "load_trials_of_both",
    "measure",
    "noise_at_speeds",
    "noise_of_further",
    "noise_of_unknown_ship",
    "of_joint_fit",
    "of_legs",
    "of_vessel",
    "pairs_of",
    "priors_of",
    "response_of",
    "responses_of",
    "run",
    "run_both",
    "set_point_scaled",
    "settings_by_name",
    "settings_text",
    "ship_numbers",
    "stated_working_point",
    "structure_at",
    "survey_of",
    "thesis_way",
    "validated_apart",
    "validations_of",
    "validations_with_limits",
    "wash_on",
    "wash_sentences",
    "weighted_fits",
    "with_everything",
    "with_limits",
    "with_validation",
]

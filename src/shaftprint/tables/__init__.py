"""Tables: made once, printed on the terminal by the commands and on a page by the report.

================== ========= ==================================================================================
quantity           unit      how it is written
================== ========= ==================================================================================
value ± std        -         both rounded to the second digit of the standard deviation
interval           -         95 %; an end that a bound of the search sets is marked with an asterisk
speed              rpm       of the engine
share              %         of a variance, of the motion, of the truth
difference         %         from the value of the vessel file, relative to it
================== ========= ==================================================================================

Every ``*_table`` function returns a ``Table`` of plain text. Who prints it escapes what is foreign in it, and turns
its letters (±, a true minus sign, a narrow space between thousands) into those that the place has.
"""

from shaftprint.digits import interval, p_value_text, plain, rounded, to_digit_of, unit_text, with_deviation
from shaftprint.plain_table import MEANING, Column, Symbol, Table, numbers, texts
from shaftprint.tables._conditions import ship_text, tested_text, water_facts
from shaftprint.tables._drive import (
    drive_assumed_table,
    drive_difference_table,
    drive_prediction_table,
    drive_record_table,
    drive_response_table,
    time_comparison_table,
    validated_drive_table,
)
from shaftprint.tables._fingerprint import (
    NO_TRUTH,
    budget_table,
    combination_table,
    expected_text,
    fit_table,
    limits,
    margin_table,
    parameter_table,
    physical_table,
    quantity_table,
    truth_of_combinations,
)
from shaftprint.tables._inertia import (
    expected_inertia_table,
    inertia_budget_table,
    mass_table,
    mode_table,
    two_mass_sentence,
    water_table,
)
from shaftprint.tables._legs import leg_table, leg_test_table
from shaftprint.tables._limit_uses import limit_use_sentences, limit_use_table
from shaftprint.tables._plan import (
    abort_table,
    planned_leg_table,
    predicted_number_table,
    standing_leg_table,
    standing_table,
    wish_table,
)
from shaftprint.tables._recording import clock_deviations, clock_map_table, clock_table, level_table
from shaftprint.tables._signals import (
    calibration_table,
    local_ratio_table,
    overall_ratio_table,
    repair_table,
    speed_table,
    step_table,
    strip_table,
    window_table,
)
from shaftprint.tables._structures import fits_table, structure_tables
from shaftprint.tables._validation import excerpt_name, misfit_table, models_table, step_number_table

__all__ = [
    "MEANING",
    "NO_TRUTH",
    "Column",
    "Symbol",
    "Table",
    "abort_table",
    "budget_table",
    "calibration_table",
    "clock_deviations",
    "clock_map_table",
    "clock_table",
    "combination_table",
    "drive_assumed_table",
    "drive_difference_table",
    "drive_prediction_table",
    "drive_record_table",
    "drive_response_table",
    "excerpt_name",
    "expected_inertia_table",
    "expected_text",
    "fit_table",
    "fits_table",
    "inertia_budget_table",
    "interval",
    "leg_table",
    "leg_test_table",
    "level_table",
    "limit_use_sentences",
    "limit_use_table",
    "limits",
    "local_ratio_table",
    "margin_table",
    "mass_table",
    "misfit_table",
    "mode_table",
    "models_table",
    "numbers",
    "overall_ratio_table",
    "p_value_text",
    "parameter_table",
    "physical_table",
    "plain",
    "planned_leg_table",
    "predicted_number_table",
    "quantity_table",
    "repair_table",
    "rounded",
    "ship_text",
    "speed_table",
    "standing_leg_table",
    "standing_table",
    "step_number_table",
    "step_table",
    "strip_table",
    "structure_tables",
    "tested_text",
    "texts",
    "time_comparison_table",
    "to_digit_of",
    "truth_of_combinations",
    "two_mass_sentence",
    "unit_text",
    "validated_drive_table",
    "water_facts",
    "water_table",
    "window_table",
    "wish_table",
    "with_deviation",
]

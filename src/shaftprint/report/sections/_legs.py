"""The legs of a campaign: how well one model explains each of them, and their responses."""

from functools import partial

from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section, picture_name
from shaftprint.tables._legs import leg_table, leg_test_table


def leg_section(inputs: Inputs) -> list[Section]:
    """Return the legs; nothing for a campaign without any."""
    if not inputs.legs:
        return []
    tests = [leg_test_table(inputs.leg_tests, p_value=inputs.identification.p_value)] if inputs.leg_tests else []
    pictures = []
    for leg in inputs.legs:
        response, limit = leg.spectra.response, inputs.signals.about(leg.name).engine_speed.nyquist_hz
        pictures.append(
            Picture(
                name=picture_name("leg", leg.name),
                caption=f"Leg {leg.name}: response of speed and torque about its working point, 95 % intervals.",
                alt=f"Bode diagram of measured engine speed and shaft torque over set point, leg {leg.name}.",
                chart=partial(bode_chart, data=response, aliasing_limit_hz=limit),
            )
        )
    return [Section(key="legs", title="Legs", tables=(leg_table(inputs.legs), *tests), pictures=pictures)]

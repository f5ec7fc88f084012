"""A noun as a picture: which chart shows it best, drawn by matplotlib for notebooks and papers."""

from typing import TYPE_CHECKING, TypeAlias

from shaftprint.catalogue._thesis import STRUCTURES, structure
from shaftprint.errors import ReportError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._budget import Budget
from shaftprint.limits._limit_fit import LimitFit
from shaftprint.report._curve import Curve, fingerprint_curve
from shaftprint.report.charts._chart import Chart
from shaftprint.report.charts._pictures import draw
from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.figures._covariance import budget_chart
from shaftprint.report.figures._fit import fit_chart
from shaftprint.report.figures._limits import limit_chart
from shaftprint.report.figures._modes import mode_chart
from shaftprint.report.figures._time_series import signal_chart
from shaftprint.report.figures._validation import validation_summary_chart
from shaftprint.signals._signals import Signals
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._spectra import Spectra
from shaftprint.survey._survey import Survey
from shaftprint.torsion._modes import Modes
from shaftprint.validation._validation import Validation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Noun: TypeAlias = (
    Chart
    | Signals
    | FrequencyResponse
    | Spectra
    | Curve
    | Identification
    | Fingerprint
    | Validation
    | Budget
    | Modes
    | LimitFit
    | Survey
)


def plot(noun: Noun) -> "Figure":
    """Return a noun as a figure of matplotlib, which belongs to nobody else.

    ====================== ====================================================================================
    noun                   what is drawn
    ====================== ====================================================================================
    ``Chart``              the chart
    ``Signals``            set point, speed and torque over the recording
    ``FrequencyResponse``  Bode diagram with 95 % intervals; of ``Spectra`` that of their response
    ``Curve``              Bode diagram of the model
    ``Identification``     Bode diagram of model and data, residuals below; of a ``Survey`` that of its first fit
    ``Fingerprint``        Bode diagram of the identified model with its 95 % band
    ``Validation``         what the model misses of each excerpt
    ``Budget``             share of each source in the variance of every number
    ``Modes``              shapes of the slowest torsional modes
    ``LimitFit``           torque of the engine over speed, with its limit
    ====================== ====================================================================================

    Parameters
    ----------
    noun
        What is drawn.

    Raises
    ------
    ReportError
        If nothing is known to draw of such a noun.
    """
    return draw(chart_of(noun))


def chart_of(noun: Noun) -> Chart:
    """Return the chart that shows a noun best; see ``plot``.

    ``noun``: what is shown. Raises ReportError if nothing is known to draw of such a noun.
    """
    match noun:
        case Chart():
            return noun
        case Signals():
            return signal_chart(noun)
        case FrequencyResponse():
            return bode_chart(data=noun)
        case Spectra():
            return bode_chart(data=noun.response)
        case Curve():
            return bode_chart([noun])
        case Identification():
            return fit_chart(noun)
        case Survey():
            return fit_chart(noun.identification)
        case Fingerprint():
            return bode_chart([_identified(noun)])
        case Validation():
            return validation_summary_chart(noun)
        case Budget():
            return budget_chart(noun)
        case Modes():
            return mode_chart(noun)
        case LimitFit():
            return limit_chart(noun)
        case _:
            raise ReportError(
                "plot: expected a chart, signals, a response, a fit, a fingerprint or another noun that can be drawn, "
                f"found {type(noun).__name__}."
            )


def _identified(fingerprint: Fingerprint) -> Curve:
    if fingerprint.structure not in STRUCTURES:
        raise ReportError(
            f"plot: expected a fingerprint of a structure that is shipped, found {fingerprint.structure}; draw the "
            "identification, or a Curve of your structure."
        )
    return fingerprint_curve(fingerprint, structure(fingerprint.structure), fingerprint.structure)

"""Records without test lines, arbitrary or periodic: from arrays to responses with covariance."""

from shaftprint.spectra.records._arbitrary import Arbitrary
from shaftprint.spectra.records._excitation import Excitation
from shaftprint.spectra.records._from_arrays import response_from_arrays
from shaftprint.spectra.records._local_polynomial import Bands, Transform, is_smooth
from shaftprint.spectra.records._periodic import Periodic
from shaftprint.spectra.records._records import read_records

__all__ = [
    "Arbitrary",
    "Bands",
    "Excitation",
    "Periodic",
    "Transform",
    "is_smooth",
    "read_records",
    "response_from_arrays",
]

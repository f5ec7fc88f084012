"""Frequency responses from sine tests, with covariance."""

from shaftprint.spectra._frequency_response import FrequencyResponse

__all__ = ["FrequencyResponse"]

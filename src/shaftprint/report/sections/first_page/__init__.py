"""The first page of the report of one fingerprint, for the superintendent."""

from shaftprint.report.sections.first_page._cover_of import cover_of

__all__ = ["cover_of"]

"""The first pages of a report as PDF, for a mail or a file: page one and the engineer's summary.

ReportLab is imported here, and is needed by nothing else: ``report`` loads this folder when a PDF is asked for.
"""

"""The first section of a report: whether the numbers may be used, in words."""

from shaftprint.report._sections import Inputs, Section


def verdict_section(inputs: Inputs) -> Section:
    """Return the verdict on the fit, the reason first."""
    verdict = inputs.fingerprint.verdict
    words = "trustworthy" if verdict.trustworthy else "not trustworthy"
    return Section(
        key="verdict",
        title=f"Verdict: the fit is {words}",
        paragraphs=(verdict.reason,),
        points=verdict.sentences[1:],
    )

"""A fingerprint as tables on the terminal."""

from collections.abc import Mapping, Sequence

from shaftprint.cli._numbers import plain, with_uncertainty
from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.fingerprint import Conditions, Fingerprint, Quantity
from shaftprint.identify import Verdict

NO_TRUTH: Mapping[str, float] = {}
PERCENT = 100.0
SMALLEST_PERCENT = 0.5


def print_fingerprint(fingerprint: Fingerprint, *, truth: Mapping[str, float] = NO_TRUTH) -> None:
    """Print verdict, conditions, parameters, physical values, margins, quality and findings.

    Parameters
    ----------
    fingerprint
        What to print.
    truth
        True values by the names of parameters, combinations and physical values, where they are known.
    """
    _print_verdict(fingerprint.verdict)
    _print_conditions(fingerprint)
    normalised = (*fingerprint.parameters, *fingerprint.combinations)
    _print_quantities(f"{fingerprint.structure}: parameters, normalised at the working point", normalised, truth)
    _print_quantities(
        "Physical values, at the propeller shaft unless the unit says otherwise", fingerprint.physical, truth
    )
    _print_priors(fingerprint)
    if fingerprint.margins:
        _print_quantities("Stability margins", fingerprint.margins, truth)
    _print_budget(fingerprint)
    _print_quantities("What the recording tells of its sensors", fingerprint.calibration, truth)
    _print_quality(fingerprint)
    print_findings("Findings", (*fingerprint.findings, *fingerprint.quality.remarks))


def _print_verdict(verdict: Verdict) -> None:
    words = "trustworthy" if verdict.trustworthy else "not trustworthy"
    print_findings(f"Verdict: {words}", verdict.sentences)


def print_findings(title: str, findings: Sequence[str]) -> None:
    """Print findings in words, one a line, under a title."""
    echo(title)
    for finding in findings or ("None.",):
        echo(f"  * {finding}")
    echo()


def _print_conditions(fingerprint: Fingerprint) -> None:
    where: Conditions = fingerprint.conditions
    echo(f"{where.vessel}; {where.campaign}")
    for quantity in (where.engine_speed, where.shaft_torque):
        value = with_uncertainty(quantity.value, quantity.std)
        echo(f"  {quantity.meaning}: {quantity.name} = {value} {quantity.unit}")
    echo(f"  speed sensor {where.speed_channel}; signals prepared in {where.mode} mode")
    echo(f"  lines used: {', '.join(where.lines_used)}")
    if where.lines_left_out:
        echo(f"  lines left out: {', '.join(where.lines_left_out)}")
    for source in fingerprint.sources:
        echo(f"  {source.role} {source.name}: SHA-256 {source.sha256[:16]}...")
    echo(f"  made {fingerprint.created:%Y-%m-%d %H:%M %Z} with shaftprint {fingerprint.shaftprint_version}\n")


def _print_priors(fingerprint: Fingerprint) -> None:
    known = [f"{name} = {plain(prior.mean)} +/- {plain(prior.std)}" for name, prior in fingerprint.priors.items()]
    held = [f"{name} = {plain(value)}" for name, value in fingerprint.held.items()]
    echo(f"  known beforehand: {', '.join(known) or 'nothing'}; held: {', '.join(held) or 'nothing'}\n")


def _print_quantities(title: str, quantities: Sequence[Quantity], truth: Mapping[str, float]) -> None:
    """Print quantities; columns that nothing would fill are left out."""
    known = any(quantity.name in truth for quantity in quantities)
    expected = any(quantity.expected is not None for quantity in quantities)
    columns = ["quantity", "unit", "value +/- 1 std"]
    profiled = any(quantity.interval_95 is not None for quantity in quantities)
    columns += ["95 % interval"] * profiled + ["expected"] * expected + ["truth", "off by [std]"] * known + ["meaning"]
    rows = []
    for quantity in quantities:
        row = [quantity.name, quantity.unit, _value(quantity)]
        row += [_interval(quantity)] * profiled
        row += [_expected(quantity)] * expected + _against(quantity, truth) * known + [quantity.meaning]
        rows.append(row)
    print_table(title, columns, rows, numbers=range(2, len(columns) - 1), spare=True)


def _value(quantity: Quantity) -> str:
    """Return value and standard deviation; the value alone where only its interval tells how well it is known."""
    std = quantity.stated_std
    text = plain(quantity.value) if std is None else with_uncertainty(quantity.value, std)
    return text + (" at bound" if quantity.at_bound else "")


def _interval(quantity: Quantity) -> str:
    """Return the profile-likelihood interval; an end that only a bound of the search sets is marked."""
    if quantity.interval_95 is None:
        return ""
    ends = [
        f"{'bound ' if is_open else ''}{end:.4g}"
        for end, is_open in zip(quantity.interval_95, quantity.interval_open, strict=True)
    ]
    return " to ".join(ends)


def _expected(quantity: Quantity) -> str:
    if quantity.expected is None:
        return ""
    if quantity.expected_std is None:
        return plain(quantity.expected)
    return with_uncertainty(quantity.expected, quantity.expected_std)


def _against(quantity: Quantity, truth: Mapping[str, float]) -> list[str]:
    if quantity.name not in truth:
        return ["", ""]
    true = truth[quantity.name]
    off = (quantity.value - true) / quantity.std if quantity.std > 0.0 else 0.0
    return [f"{true:.6g}", f"{off:+.1f}"]


def _print_budget(fingerprint: Fingerprint) -> None:
    """Print which source contributes what to the variance of every number."""
    stated = fingerprint.budget
    rows = [
        (row.name, *(_share(PERCENT * row.shares.get(source, 0.0)) for source in stated.sources))
        for row in stated.rows
        if row.shares
    ]
    if rows:
        print_table(
            "Where the uncertainty comes from: share of the variance [%]",
            ("quantity", *stated.sources),
            rows,
            numbers=range(1, len(stated.sources) + 1),
        )


def _share(percent: float) -> str:
    """Return a share without decimals; nothing for one that would be printed as 0."""
    return f"{percent:.0f}" if abs(percent) >= SMALLEST_PERCENT else ""


def _print_quality(fingerprint: Fingerprint) -> None:
    quality = fingerprint.quality
    rows = [
        (output, f"{percent:.2f}", f"{quality.fit_ceiling[output]:.2f}")
        for output, percent in quality.fit_percent.items()
    ]
    print_table("How well the model explains the data", ("output", "FitPercent", "perfect model"), rows, numbers=(1, 2))
    square = "" if quality.chi_square is None else f"chi-square {quality.chi_square:.1f} for "
    chance = "" if quality.p_value is None else f" (p = {quality.p_value:.2g})"
    echo(
        f"  {square}{quality.degrees_of_freedom} degrees of freedom{chance}; "
        f"{quality.starts_at_optimum} of {quality.starts} starts reached this optimum\n"
    )

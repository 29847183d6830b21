"""What checks found, as one HTML page that needs nothing but itself."""

from __future__ import annotations

import html
import io
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import steradian as sr
from steradian.verification.found import Failure, Found, Row

TITLE = "Every check on every block"


def page(found: Found) -> str:
    """The whole page. Plots of failures need Matplotlib, and are left out without it."""
    import steradian.article

    style = (Path(steradian.article.__file__).parent / "page.css").read_text(encoding="utf-8")
    body = "\n".join([_head(found), _table(found), *_failures(found), _flaws(found)])
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{TITLE}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _head(found: Found) -> str:
    blocks = {(row.group, row.block) for row in found.rows}
    cases = sum(row.cases for row in found.rows)
    failed, missed = len(found.failures), len(found.missed)
    verdict = '<b class="holds">All hold.</b>' if not failed else f'<b class="fails">{failed} fail.</b>'
    if found.flaws:
        caught = f"{len(found.flaws) - missed} of {len(found.flaws)} deliberate flaws were caught."
        verdict += f' <span class="{"fails" if missed else "holds"}">{caught}</span>'
    return f"""
<h1>{TITLE}</h1>
<p class="lead">A sampler that does not match its density is the commonest serious bug of renderers. So every
scattering model, light and distribution is checked, with many parameters and from many directions.</p>
<p class="facts">{verdict} {cases} checks of {len(blocks)} blocks, {found.tests} of them decided by chance: a
p-value below {found.level:.1e} fails, so that one run in {1 / found.failure_rate:.0f} raises a false alarm.
Steradian {sr.__version__}, seed {found.seed}, {found.seconds:.0f} seconds.</p>"""


def _table(found: Found) -> str:
    lines = []
    for (group, block), rows in groupby(found.rows, lambda row: (row.group, row.block)):
        checks = list(rows)
        lines.append(
            f"<tr><td>{group}</td><td>{html.escape(block)}</td>"
            f'<td class="number">{max(row.cases for row in checks)}</td>'
            f"<td>{' · '.join(map(_check, checks))}</td>"
            f'<td class="number">{_least(checks)}</td></tr>'
        )
    return f"""<h2>Blocks</h2>
<div class="scroll"><table>
<thead><tr><th></th><th>Block</th><th>Cases</th><th>Checks</th><th>Least p</th></tr></thead>
<tbody>
{chr(10).join(lines)}
</tbody></table></div>"""


def _check(row: Row) -> str:
    name = html.escape(row.check)
    if row.failures:
        return f'<span class="fails">✗ {name}: {len(row.failures)} of {row.cases}</span>'
    return f'<span class="holds">✓</span> {name}'


def _least(rows: list[Row]) -> str:
    least = min(row.least_p for row in rows)
    return "" if least == 1 else f"{least:.2g}"


def _failures(found: Found) -> Iterator[str]:
    if not found.failures:
        return
    yield "<h2>What fails</h2>"
    for row, failure in found.failures:
        yield (
            f'<div class="mistake no"><b>{html.escape(failure.case)}</b>, {html.escape(row.check)}'
            f'<p class="said">{html.escape(failure.what)}</p></div>'
        )
        yield _plot(failure)


def _plot(failure: Failure) -> str:
    """Where samples go, where the density says that they go, and the difference."""
    if failure.drawn is None or failure.expected is None:
        return ""
    try:
        import matplotlib
        import numpy as np
        from matplotlib.figure import Figure
    except ImportError:
        return "<p>Plots need Matplotlib: pip install matplotlib</p>"
    drawn, expected = (np.array(cells).reshape(48, 96) for cells in (failure.drawn, failure.expected))
    top = max(float(expected.max()), 1e-9)
    off = (drawn - expected) / np.sqrt(np.maximum(expected, 1e-6) / (1 << 18))
    figure = Figure(figsize=(9.6, 2.1), layout="constrained")
    shown = [
        (drawn, "samples", (0.0, top), "viridis"),
        (expected, "density", (0.0, top), "viridis"),
        (off, "difference, in standard errors", (-8.0, 8.0), "RdBu"),
    ]
    for axes, (cells, title, (low, high), colours) in zip(figure.subplots(1, 3), shown, strict=True):
        image = axes.imshow(cells, extent=(0, 360, -1, 1), aspect="auto", vmin=low, vmax=high, cmap=colours)
        axes.set(title=title, xlabel="azimuth, degrees", ylabel="cos θ")
        figure.colorbar(image, ax=axes)
    buffer = io.StringIO()
    # The same page for the same findings: names of parts do not come from chance.
    with matplotlib.rc_context({"svg.hashsalt": "steradian"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    svg = buffer.getvalue()
    return f'<figure class="row">{svg[svg.index("<svg") :]}</figure>'


def _flaws(found: Found) -> str:
    if not found.flaws:
        return ""
    lines = [
        f"<tr><td>{html.escape(flaw.case)}</td>"
        + (
            f'<td><span class="holds">✓</span> {html.escape(flaw.caught_by)}</td></tr>'
            if flaw.caught_by
            else '<td class="fails">✗ nothing noticed</td></tr>'
        )
        for flaw in found.flaws
    ]
    return f"""<h2>Deliberate flaws</h2>
<p>Checks that cannot fail prove nothing. So blocks are broken on purpose, and each must be caught.</p>
<div class="scroll"><table>
<thead><tr><th>What is wrong</th><th>Caught by</th></tr></thead>
<tbody>
{chr(10).join(lines)}
</tbody></table></div>"""

"""From chapters to one HTML page that needs nothing but itself: styles, plots and pictures are inside."""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from pathlib import Path

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import (
    LEVEL,
    ROUNDING,
    Block,
    Chapter,
    Code,
    Finding,
    Mistake,
    Pictures,
    Plots,
    Text,
)
from steradian.integration.estimate import format_uncertain

TITLE = "Monte Carlo integration, as it ran"
ARTICLE = "Taehwan Kim, “Monte Carlo and Importance Sampling for Rendering”, 2025"

FAR_TOO_NEAR = 1e-3
"""A truth within so few standard errors is not chance: once in a thousand runs."""


def page(chapters: Sequence[Chapter], seed: int, seconds: float) -> str:
    """The whole page, from finished chapters."""
    style = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")
    body = "\n".join(
        [
            _head(chapters, seed, seconds),
            _contents(chapters),
            _table(chapters),
            *map(_chapter, chapters),
            _foot(),
        ]
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{TITLE}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def plain(text: str) -> str:
    """HTML as plain text: tags gone, entities resolved."""
    return html.unescape(re.sub(r"<[^>]+>", "", text))


def by_chance(tests: int) -> float:
    """How likely it is that at least one of so many right values falls outside of its interval."""
    return 1 - LEVEL**tests


def _head(chapters: Sequence[Chapter], seed: int, seconds: float) -> str:
    findings = [finding for chapter in chapters for finding in chapter.findings]
    held = sum(finding.holds for finding in findings)
    mistakes = [mistake for chapter in chapters for mistake in chapter.mistakes]
    caught = sum(mistake.caught for mistake in mistakes)
    quick = " A quick run: a sixteenth of the samples." if any(chapter.quick for chapter in chapters) else ""
    return f"""
<h1>{TITLE}</h1>
<p class="lead">An integral is the mean of <i>f</i>(<i>X</i>)/<i>p</i>(<i>X</i>). Everything else is choosing
<i>p</i>: from throwing points at a circle to a lit room.</p>
<p>This page follows the experiments of an article on Monte Carlo integration in rendering. Every number
and every plot on it was computed when the page was made, by the code that stands beside it; paste it
into a Python that has Steradian, and it gives the same numbers. Every value has a standard error, and
is compared with the exact one.</p>
<p class="facts">{held} of {len(findings)} measured values hold, {caught} of {len(mistakes)} deliberate
mistakes were caught. Steradian {sr.__version__}, seed {seed}, {seconds:.0f} seconds.{quick}</p>"""


def _contents(chapters: Sequence[Chapter]) -> str:
    items = "\n".join(f'<li><a href="#{c.slug}">{html.escape(c.title)}</a></li>' for c in chapters)
    return f'<nav aria-label="Contents">\n<ol>\n{items}\n</ol>\n</nav>'


def _table(chapters: Sequence[Chapter]) -> str:
    findings = [finding for chapter in chapters for finding in chapter.findings]
    random = sum(not finding.exactly for finding in findings)
    rows = []
    for chapter in chapters:
        if chapter.findings:
            link = f'<a href="#{chapter.slug}">{html.escape(chapter.title)}</a>'
            rows.append(f'<tr><td class="part" colspan="5">{link}</td></tr>')
        rows.extend(_row(finding) for finding in chapter.findings)
    head = "".join(f"<th>{name}</th>" for name in ("", "claimed", "measured", "exact", "deviation"))
    return f"""
<h2 id="results">All results</h2>
<p>“Claimed” is what the article says of it, where it says something. “Deviation” is how far the
measured value is from the exact one, in standard errors. A value holds if the exact one lies in its
{100 * LEVEL:g}&nbsp;% interval, by Student’s t; where there is no variance, only rounding is
allowed.</p>
<div class="scroll"><table class="wide">
<thead><tr>{head}</tr></thead>
<tbody>
{chr(10).join(rows)}
</tbody></table></div>
<p>With {random} values that have an error, and with everything right, at least one of them falls
outside of its interval in {100 * by_chance(random):.1f}&nbsp;% of runs, by chance. So one failure with
another seed means little; a second one in the same place means that something is wrong. The default
seed was chosen once, and before there were results.</p>"""


def _row(finding: Finding) -> str:
    verdict = f'<span class="{"holds" if finding.holds else "fails"}">{_deviation(finding)}</span>'
    claimed = f"<span>{finding.claimed}</span>" if finding.claimed else ""
    return (
        f'<tr><td class="what">{finding.what}</td><td data-name="claimed">{claimed}</td>'
        f'<td class="number" data-name="measured">{_measured(finding)}</td>'
        f'<td data-name="exact"><span>{_exact(finding)}</span></td>'
        f'<td class="number" data-name="deviation">{verdict}</td></tr>'
    )


def _measured(finding: Finding) -> str:
    """Mean and error; the mean alone where only rounding is allowed."""
    mean, stderr = float(finding.estimate.mean), float(finding.estimate.stderr)
    if finding.exactly:
        return _number(
            mean if abs(mean - finding.exact) > ROUNDING * max(1.0, abs(finding.exact)) else finding.exact
        )
    return format_uncertain(mean, stderr).replace("-", "−")


def _number(value: float) -> str:
    return f"{value:.7g}".replace("-", "−")


def _exact(finding: Finding) -> str:
    """The number, and where it comes from."""
    number = _number(finding.exact)
    return f"{number} ({finding.formula})" if finding.formula and finding.formula != number else number


def _deviation(finding: Finding) -> str:
    if finding.exactly:
        return "exact" if finding.holds else "not exact"
    sign = f"{finding.deviation:+.2f}".replace("-", "−")
    return sign if finding.holds else f"{sign}, does not hold"


def _chapter(chapter: Chapter) -> str:
    parts = [f'<section id="{chapter.slug}">', f"<h2>{html.escape(chapter.title)}</h2>"]
    parts += [_block(block, f"{chapter.slug}-{i}") for i, block in enumerate(chapter.blocks)]
    return "\n".join([*parts, "</section>"])


def _block(block: Block, name: str) -> str:
    match block:
        case Text(text):
            parts = [part.strip() for part in text.split("\n\n")]
            return "\n".join(
                part if part.startswith(("<h3", '<span class="formula')) else f"<p>{part}</p>"
                for part in parts
            )
        case Code(source, output):
            return f'<pre>{html.escape(source)}\n<span class="out">{html.escape(output)}</span></pre>'
        case Plots(figures, caption):
            drawn = "\n".join(
                plots.svg(figure, f"{name}-{i}", alt) for i, (figure, alt) in enumerate(figures)
            )
            return f'<figure><div class="row">{drawn}</div><figcaption>{caption}</figcaption></figure>'
        case Pictures(images, caption):
            shown = "\n".join(_image(*image) for image in images)
            return f'<figure><div class="row grid">{shown}</div><figcaption>{caption}</figcaption></figure>'
        case Finding():
            return _finding(block)
        case Mistake():
            return _mistake(block)


def _image(png: bytes, caption: str) -> str:
    text = html.escape(caption)
    data = base64.b64encode(png).decode("ascii")
    return f'<div><img src="data:image/png;base64,{data}" alt="{text}">{text}</div>'


def _finding(finding: Finding) -> str:
    kind = "measured" if finding.holds else "measured no"
    if finding.exactly:
        rest = "equal but for rounding" if finding.holds else "not equal"
    else:
        rest = f"{_deviation(finding)} standard errors"
    return f'<div class="{kind}">{finding.what}: {_measured(finding)}; exact {_exact(finding)}; {rest}.</div>'


def _mistake(mistake: Mistake) -> str:
    parts = []
    if mistake.answer is not None:
        mean, stderr = float(mistake.answer.mean), float(mistake.answer.stderr)
        away = abs(mean - mistake.exact) / stderr
        says = f"It says {format_uncertain(mean, stderr)}; the truth is {mistake.exact:.6g}, "
        if away < FAR_TOO_NEAR:
            parts.append(f"{says}so near that it is the error which is wrong: far too large.")
        else:
            parts.append(f"{says}{away:,.3g} of its standard errors away.")
    if mistake.message is None:
        parts.append(f'<span class="fails">Not caught by</span> <code>{html.escape(mistake.check)}</code>.')
    else:
        parts.append(
            f"Caught by <code>{html.escape(mistake.check)}</code>:<br>"
            f'<span class="said">{html.escape(mistake.message)}</span>'
        )
    kind = "mistake" if mistake.caught else "mistake no"
    return f'<div class="{kind}">{" ".join(parts)}</div>'


def _foot() -> str:
    return (
        f'<footer><p class="facts">The article: {ARTICLE}. Text, code and plots of this page are '
        "Steradian’s own. Make it again: <code>steradian article</code>.</p></footer>"
    )

"""The article: every value on its page holds, what is not right is said, and the page stands alone."""

from __future__ import annotations

import contextlib
import html
import io
import re
import types
from collections import Counter
from html.parser import HTMLParser

import numpy as np
import pytest
from conftest import CORNELL_BOX

import steradian as sr
from steradian import article, cli
from steradian.article import chapters
from steradian.article.chapter import LEVEL, Chapter, Code
from steradian.article.chapters import area_light, cornell_box
from steradian.article.page import by_chance


@pytest.fixture(scope="module")
def written() -> article.Written:
    """A quick run with the default seed."""
    return article.write(quick=True)


def test_every_value_holds_and_every_mistake_is_caught(written):
    assert len(written.findings) > 30
    assert len(written.mistakes) > 5
    wrong = [f"{f.chapter}: {f.what}: {f.estimate}, not {f.exact}" for f in written.findings if not f.holds]
    assert not wrong
    assert [m.what for m in written.mistakes if not m.caught] == []
    assert written.holds


def test_mistakes_give_wrong_answers(written):
    """Otherwise they would show nothing."""
    wrong = [m for m in written.mistakes if m.answer is not None and "Sobol" not in m.what]
    assert len(wrong) >= 5
    for mistake in wrong:
        low, high = mistake.answer.interval(LEVEL)
        assert not low <= mistake.exact <= high, mistake


def test_code_on_the_page_gives_the_numbers_on_the_page(written):
    """All of it, in namespaces of its own."""
    codes = [block for chapter in written.chapters for block in chapter.blocks if isinstance(block, Code)]
    assert len(codes) > 25
    for code in codes:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code.source, "page", "exec"), {"__name__": "page"})
        assert printed.getvalue().strip() == code.output, code.source
        assert html.escape(code.source) in written.html


class Page(HTMLParser):
    """Checks that tags are closed in order; collects identifiers, links and sources."""

    VOID = ("meta", "img", "br", "link", "input", "hr")

    def __init__(self) -> None:
        super().__init__()
        self.open, self.ids, self.links, self.sources, self.tags = [], Counter(), [], [], Counter()

    def handle_starttag(self, tag, attributes):
        self.tags[tag] += 1
        values = dict(attributes)
        if "id" in values:
            self.ids[values["id"]] += 1
        self.links += [v for k, v in attributes if k in ("href", "xlink:href")]
        self.sources += [v for k, v in attributes if k == "src"]
        if tag == "img":
            assert values["alt"]
        if tag == "svg":
            assert values["role"] == "img"
            assert values["aria-label"]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_stands_alone(written):
    page = Page()
    page.feed(written.html)
    page.close()
    assert page.open == []
    assert [name for name, count in page.ids.items() if count > 1] == []
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links)
    assert page.sources and all(source.startswith("data:image/png;base64,") for source in page.sources)
    assert page.tags["script"] == page.tags["link"] == 0
    assert not re.search(r"url\((?!#)|@import", written.html)
    assert page.tags["svg"] > 10
    assert len(page.sources) == len(cornell_box.STRATEGIES) + 1


def test_the_page_lists_every_value_once(written):
    table = written.html[written.html.index("<table") : written.html.index("</table>")]
    assert table.count('class="what"') == len(written.findings)
    for chapter in written.chapters:
        assert f'href="#{chapter.slug}"' in table or not chapter.findings
        assert f'<section id="{chapter.slug}">' in written.html


def test_plots_follow_the_colours_of_the_page(written):
    """What is not in the style sheet would vanish in the dark."""
    colours = set(re.findall(r"(?:fill|stroke): (#[0-9a-f]{6})", written.html))
    assert colours <= {"#ffffff"}, colours


def test_chance_is_said(written):
    random = sum(not finding.exactly for finding in written.findings)
    assert f"{100 * (1 - 0.999**random):.1f}" in written.html
    assert by_chance(1) == pytest.approx(1e-3)


def test_other_seeds_give_other_values(written):
    assert article.DEFAULT_SEED == 1
    seeds = [
        re.search(r"seed=([\d_]+)\)", code.source)
        for code in written.chapters[0].blocks
        if isinstance(code, Code)
    ]
    assert len({match[1] for match in seeds if match}) == len(seeds)


def only(monkeypatch, tell):
    """An article of one chapter."""
    module = types.ModuleType("steradian.article.chapters.the_only_one")
    module.TITLE, module.tell = "The only one", tell
    monkeypatch.setattr(chapters, "CHAPTERS", [module])


def estimate_of_two() -> sr.Estimate:
    return sr.Estimate(mean=2.0, stderr=0.1, n=100, dof=99)


def test_a_value_that_does_not_hold_is_said(monkeypatch, tmp_path, capsys):
    def tell(page: Chapter) -> None:
        page.measure("right", estimate_of_two(), 2.1)
        page.measure("<i>wrong</i>", estimate_of_two(), 3.0)

    only(monkeypatch, tell)
    path = tmp_path / "page.html"
    assert cli.main(["article", "-o", str(path)]) == 1
    said = capsys.readouterr()
    assert "1 of 2 values hold" in said.out
    assert "error: wrong (the-only-one): 2.00 ± 0.10 (n = 100), not 3" in said.err
    assert "does not hold" in path.read_text(encoding="utf-8")


def test_without_variance_only_rounding_is_allowed(monkeypatch):
    def tell(page: Chapter) -> None:
        for mean, stderr in ((25 + 1e-13, 0.0), (25 + 1e-9, 0.0), (25.0, 1e-3)):
            page.measure("25", sr.Estimate(mean, stderr, n=10, dof=9), 25.0, exactly=True)

    only(monkeypatch, tell)
    written = article.write()
    assert [finding.holds for finding in written.findings] == [True, False, False]


def test_a_mistake_that_is_not_caught_is_said(monkeypatch, tmp_path, capsys):
    only(monkeypatch, lambda page: page.mistake("harmless", None, 0.0, "nothing()", lambda: None))
    assert cli.main(["article", "-o", str(tmp_path / "page.html"), "--quiet"]) == 1
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == "error: harmless: not caught\n"


def test_progress_goes_to_standard_error(monkeypatch, tmp_path, capsys):
    only(monkeypatch, lambda page: page.measure("right", estimate_of_two(), 2.1))
    path = tmp_path / "page.html"
    assert cli.main(["article", "-o", str(path), "--seed", "3"]) == 0
    said = capsys.readouterr()
    assert said.err == " 1/1  The only one\n"
    assert said.out == f"1 of 1 values hold, 0 of 0 mistakes caught; wrote {path}\n"
    assert "seed 3" in path.read_text(encoding="utf-8")


def test_a_page_that_cannot_be_written_is_said_first(monkeypatch, tmp_path, capsys):
    only(monkeypatch, lambda page: pytest.fail("should not run"))
    assert cli.main(["article", "-o", str(tmp_path / "nowhere" / "page.html")]) == 1
    assert "there is no folder" in capsys.readouterr().err
    assert cli.main(["article", "-o", str(tmp_path)]) == 1
    assert "is a directory" in capsys.readouterr().err


def test_without_matplotlib_the_remedy_is_said(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    path = tmp_path / "page.html"
    assert cli.main(["article", "-o", str(path)]) == 1
    assert 'pip install "steradian[article]"' in capsys.readouterr().err
    assert not path.exists()


def test_the_box_is_that_of_the_scene_file():
    settings = {"spp": 4, "size": (48, 48), "seed": 9}
    ours = sr.render(sr.load(cornell_box.cornell_box()), **settings)
    theirs = sr.render(sr.load(CORNELL_BOX), **settings)
    assert np.array_equal(ours.image, theirs.image)


def test_lamberts_formula_of_what_is_known():
    """A ceiling without an end, and a small lamp far above."""
    ceiling = np.array([[-1, -1, 1e-6], [1, -1, 1e-6], [1, 1, 1e-6], [-1, 1, 1e-6]])
    assert area_light.lambert(ceiling) == pytest.approx(np.pi, rel=1e-5)
    small = np.array([[0, 0, 100], [1e-2, 0, 100], [1e-2, 1e-2, 100], [0, 1e-2, 100.0]])
    assert area_light.lambert(small) == pytest.approx(1e-4 / 100**2, rel=1e-6)

"""``steradian verify``: everything holds, and what is broken is caught."""

from __future__ import annotations

import json
import re

import pytest

from steradian import verification
from steradian.cli import main
from steradian.verification import Failure, Flaw, Found, Row, page


@pytest.fixture(scope="module")
def everything():
    """All checks on all blocks."""
    return verification.run()


def test_everything_holds(everything):
    assert not everything.failures, "\n".join(
        f"{row.check}: {failure}" for row, failure in everything.failures
    )
    assert not everything.missed, [flaw.case for flaw in everything.missed]
    assert everything.holds and everything.tests > 1000
    assert everything.level < everything.failure_rate / 1000
    assert {row.group for row in everything.rows} == {block.group for block in verification.blocks()}


def test_all_kinds_of_flaw_are_among_those_that_are_caught(everything):
    kinds = {flaw.case.rsplit(", ", 1)[1] for flaw in everything.flaws}
    assert kinds == {
        "pdf scaled by 1.02",
        "axes swapped",
        "cosine lost",
        "Jacobian lost",
        "hole in the support",
    }
    assert len(everything.flaws) > 100


def test_every_check_is_there(everything):
    checks = {row.check for row in everything.rows if row.group == "bsdf"}
    assert checks == {
        "chi-square",
        "normalised",
        "delta lobes",
        "sample = eval / pdf",
        "covered",
        "reciprocal",
        "energy",
        "white furnace",
        "finite",
    }


def test_names_choose_and_numbers_stay_the_same(everything):
    found = verification.run(["diffuse"], flaws=False, threads=1)
    assert {row.block for row in found.rows} >= {"diffuse", "masked diffuse"}
    same = [row for row in everything.rows if (row.group, row.block) == ("bsdf", "diffuse")]
    again = [row for row in found.rows if (row.group, row.block) == ("bsdf", "diffuse")]
    assert [row.least_p for row in again] == [row.least_p for row in same]
    other = verification.run(["diffuse"], flaws=False, seed=2)
    assert [row.least_p for row in other.rows] != [row.least_p for row in found.rows]


def test_the_command(capsys, tmp_path):
    target = tmp_path / "checks.html"
    assert main(["verify", "weights", "filter", "--html", str(target)]) == 0
    out = capsys.readouterr().out
    assert "✓ sum to 1" in out and "✓ icdf" in out and "checks hold" in out
    html = target.read_text(encoding="utf-8")
    assert "All hold." in html and "http" not in re.sub(r'xmlns[:\w]*="[^"]*"', "", html)
    assert main(["verify", "power", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["holds"] is True
    assert main(["verify", "--list"]) == 0
    assert "bsdf: diffuse" in capsys.readouterr().out


def test_a_name_that_nothing_has(capsys):
    assert main(["verify", "diffus"]) == 0  # part of a name
    capsys.readouterr()
    assert main(["verify", "difuse"]) == 1
    assert "did you mean 'diffuse'" in capsys.readouterr().err
    with pytest.raises(ValueError, match="failure_rate is 2"):
        verification.run(failure_rate=2)


def test_failures_are_shown(capsys, monkeypatch, tmp_path):
    cells = [1 / (48 * 96)] * (48 * 96)
    row = Row("bsdf", "glass", "chi-square", 4, 1e-9, 0.1, [Failure("glass <1.5>", "p = 0", cells, cells)])
    fine = Row("bsdf", "glass", "energy", 4, 0.5, 0.1, [])
    found = Found(
        [row, fine], [Flaw("glass, hole", None), Flaw("glass, scaled", "energy")], 1e-6, 8, 1e-3, 1, 2.0
    )
    assert not found.holds
    monkeypatch.setattr(verification, "run", lambda *_, **__: found)
    target = tmp_path / "checks.html"
    assert main(["verify", "--html", str(target)]) == 1
    out, err = capsys.readouterr()
    assert "✗ chi-square (1)" in out and "✓ energy" in out and "7 of 8 checks hold" in out
    assert "error: bsdf/glass <1.5>, chi-square: p = 0" in err and "glass, hole: nothing noticed" in err
    html = target.read_text(encoding="utf-8")
    assert "glass &lt;1.5&gt;" in html and "nothing noticed" in html and "<svg" in html
    assert page(found) == html

"""All scenes, one after the other."""

from __future__ import annotations

import sys
from pathlib import Path

from beside import llvm
from gallery import arguments, pictures, renders
from gallery.compare import Verdict, compare


def main() -> int:
    """Renders, compares, writes; 1 if any pair differs."""
    asked = arguments.parse()
    known = sorted(path.stem for path in asked.scenes.glob("*.xml"))
    unknown = set(asked.scene) - set(known)
    if unknown or not known:
        print(f"error: no such scene: {', '.join(sorted(unknown)) or asked.scenes}", file=sys.stderr)
        return 2
    asked.output.mkdir(parents=True, exist_ok=True)
    _choose_variant()
    lines, failed = [], 0
    for name in asked.scene or known:
        line, same = _one(name, asked.scenes / f"{name}.xml", asked.output, asked.spp)
        failed += not same
        lines.append(line)
        print(line, flush=True)
    if not asked.scene:
        _write_table(asked.output / "README.md", lines, asked.spp)
    print(f"{len(lines) - failed} of {len(lines)} scenes agree")
    return 1 if failed else 0


def _choose_variant() -> None:
    """The compiled one, if LLVM is there."""
    llvm.point_to_it()
    import mitsuba as mi

    try:
        mi.set_variant("llvm_ad_rgb")
        import drjit as dr

        dr.eval(dr.llvm.Float(1))
    except Exception:  # whatever LLVM's absence looks like
        mi.set_variant("scalar_rgb")


def _one(name: str, path: Path, output: Path, spp: int) -> tuple[str, bool]:
    ours = renders.ours(path, spp)
    theirs = renders.mitsubas(path, spp)
    if isinstance(theirs, str):
        pictures.write(output / f"{name}.png", ours, None, None)
        return f"| {name} | ![]({name}.png) | not in Mitsuba |", True
    if theirs.image.shape != ours.image.shape:
        return f"| {name} | | sizes differ: {ours.image.shape} and {theirs.image.shape} |", False
    verdict = compare(ours, theirs)
    pictures.write(output / f"{name}.png", ours, theirs, verdict)
    return f"| {name} | ![]({name}.png) | {_says(verdict)} |", verdict.same


def _says(verdict: Verdict) -> str:
    row, column = verdict.worst_at
    text = (
        f"mean {verdict.mean_ratio:.4f} of theirs ({verdict.mean_z:+.1f} standard errors); worst block "
        f"{verdict.worst_z:.1f} of {verdict.limit:.1f} at ({column}, {row}); "
        f"{100 * verdict.share_beyond_3:.2f} % of pixels beyond 3"
    )
    return text if verdict.same else f"**differs**: {text}"


def _write_table(path: Path, lines: list[str], spp: int) -> None:
    path.write_text(
        f"""# Gallery

A small scene for every block, made by `python3 benches/gallery.py` with {spp} samples per pixel: by
Steradian, by Mitsuba 3 (where it has the block), and the difference, red where ours is brighter, blue where
darker, full at six standard errors. Pairs agree if means of 8 × 8 pixels differ by no more than chance
explains (one false alarm in a thousand scenes), and whole pictures by less than four standard errors or
0.5 %.

| block | Steradian, Mitsuba, difference | how far apart |
| --- | --- | --- |
"""
        + "\n".join(lines)
        + "\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    sys.exit(main())

"""The pages about blocks: their examples load, and no plugin is missing from them."""

import re
from pathlib import Path

import pytest

import steradian as sr

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs/blocks").glob("*.md"))
DATA = ROOT / "scenes/gallery/data"
EXAMPLES = [
    pytest.param(example, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, example in enumerate(re.findall(r"```xml\n(.*?)```", page.read_text(), re.DOTALL))
]
MITSUBA_TABLE = re.search(
    r"^## Mitsuba\n(.*?)^- ", (ROOT / "docs/import.md").read_text(), re.DOTALL | re.MULTILINE
)[1]
AROUND = {
    "bsdf": '<shape type="sphere">{}</shape>',
    "texture": '<shape type="sphere"><bsdf type="diffuse">{}</bsdf></shape>',
}


def whole_scene(example: str) -> str:
    """The example, where a scene has such things, with what else it needs."""
    example = example.replace("<texture type", '<texture name="reflectance" type', 1)
    kind = re.match(r"<(\w+)", example)[1]
    parts = [AROUND.get(kind, "{}").format(example)]
    if kind != "sensor":
        parts.append('<sensor type="perspective"><float name="fov" value="40"/></sensor>')
    if kind != "emitter":
        parts.append('<emitter type="constant"/>')
    parts.append('<shape type="sphere"/>')
    return f'<scene version="3.0.0">{"".join(parts)}</scene>'


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_load_without_a_word(example: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(re.sub(r'(name="filename" value=")', rf"\1{DATA.as_posix()}/", whole_scene(example)))
    scene = sr.load(path)
    assert scene.diagnostics == ()
    assert sr.render(scene, spp=1, size=(8, 8)).image.shape == (8, 8, 3)


def test_every_plugin_has_its_place() -> None:
    rows = re.findall(r"^\| ([\w ]+) \| (`.*`) \| (\w+) \|", MITSUBA_TABLE, re.MULTILINE)
    # What is read; integrators that are path tracing by other means are in that table alone.
    of_blocks = [
        row for row in rows if row[2] != "reported" and not row[0].startswith(("element", "integrator"))
    ]
    names = [name for row in of_blocks for name in re.findall(r"\w+", row[1])]
    assert len(names) > 60
    pages = "".join(page.read_text() for page in PAGES)
    headings = re.findall(r"^#+ .*|^\|.*", pages, re.MULTILINE)
    said = {word for line in headings for word in re.findall(r"\w+", line)}
    assert [name for name in names if name not in said] == []

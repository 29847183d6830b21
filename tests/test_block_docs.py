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
        parts.append('<sensor type="perspective"/>')
    if kind != "emitter":
        parts.append('<emitter type="constant"/>')
    parts.append('<shape type="sphere"/>')
    return f'<scene version="3.0.0">{"".join(parts)}</scene>'


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_load_without_a_word(example: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(re.sub(r'(name="filename" value=")', rf"\1{DATA.as_posix()}/", whole_scene(example)))
    scene = sr.load(path)
    assert scene.diagnostics == []
    assert sr.render(scene, spp=1, size=(8, 8)).image.shape == (8, 8, 3)


def test_every_plugin_has_its_place() -> None:
    source = (ROOT / "crates/sr_import/src/mitsuba/plugins.rs").read_text()
    names = re.findall(r'^ {12}"(\w+)",$', source, re.MULTILINE)
    names += re.findall(r'"(\w+)"', " ".join(re.findall(r'\("\w+", &\[(.*?)\]\)', source)))
    assert len(names) > 60
    pages = "".join(page.read_text() for page in PAGES)
    headings = re.findall(r"^#+ .*|^\|.*", pages, re.MULTILINE)
    said = {word for line in headings for word in re.findall(r"\w+", line)}
    assert [name for name in names if name not in said] == []

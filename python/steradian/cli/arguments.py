"""The command line's grammar, and the checks that need no scene."""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Callable, Sequence
from typing import NoReturn, TypeVar

from steradian import _internal
from steradian.limits import parse_limit
from steradian.render import MAX_SPP
from steradian.strategy import strategy

T = TypeVar("T")

EXAMPLES = """\
examples:
  steradian render scenes/cornell-box.xml                        to cornell-box.exr
  steradian render scene.xml -o a.exr -o a.png --spp 256 --exposure 1
  steradian render scene.xml --time 60 --size 640x360            as good as a minute allows
  steradian render scene.xml --strategy "0.5 cosine + 0.5 light"
  steradian render scene.xml --strategy "mis(bsdf, light, heuristic=balance)" --json
  steradian render scene.xml -D res=64 --search-path ../textures   what it names and lacks
  steradian render model.glb --environment sky.hdr               lit by an image of the sky
  steradian info scene.xml
  steradian convert scene.xml scene.pbrt                         for another renderer
  steradian article --open                                       learn how it works
  steradian verify                                               check every building block
"""

CONVERT_EXAMPLES = """\
examples:
  steradian convert scene.xml scene.pbrt           to pbrt-v4, meshes and images in the folder scene/
  steradian convert kitchen.pbrt kitchen.xml       to Mitsuba 3
  steradian convert scene.xml scene.glb            to glTF 2.0, all in one file
  steradian convert robot.gltf robot.xml --own-plugins --force
"""

VERIFY_EXAMPLES = """\
examples:
  steradian verify                             everything, in a few minutes
  steradian verify --list                      what there is
  steradian verify "rough conductor" light     some blocks, or groups of them
  steradian verify bsdf --html checks.html     and write a page, with plots of what fails
"""

ARTICLE_EXAMPLES = """\
examples:
  steradian article                            to article.html
  steradian article -o page.html --open        and show it
  steradian article --quick --seed 7           a quick look, with other samples
"""


class _Wrapped(argparse.RawDescriptionHelpFormatter):
    """Paragraphs are filled, examples stay as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith("examples:"):
            return super()._fill_text(text, width, indent)
        return argparse.HelpFormatter._fill_text(self, text, width, indent)


class _Parser(argparse.ArgumentParser):
    """Errors are one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"error: {message} (see {self.prog} --help)\n")


def parse(argv: Sequence[str] | None = None) -> argparse.Namespace:
    """The arguments, typed and checked. Exits with 2 if they make no sense."""
    parser = _Parser(
        prog="steradian",
        description="Renders scenes by Monte Carlo and says how sure it is of every pixel.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"steradian {_internal.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_render(commands)
    _add_info(commands)
    _add_convert(commands)
    _add_article(commands)
    _add_verify(commands)
    return parser.parse_args(argv)


def _add_render(commands: argparse._SubParsersAction[_Parser]) -> None:
    parser = commands.add_parser(
        "render",
        help="render a scene to image files",
        description="Renders SCENE. Succeeds only if every output was written.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_scene(parser)
    _add_environment(parser)
    add = parser.add_argument
    add(
        "-o",
        "--output",
        metavar="FILE",
        action="append",
        help="image to write: .exr has all layers, .png is for looking at; may be repeated "
        "(default: the scene's name with .exr, in the current folder)",
    )
    add("--spp", metavar="N", type=_integer(1, MAX_SPP), help="samples per pixel (default: the scene's)")
    add(
        "--time",
        metavar="SECONDS",
        type=_seconds,
        help="stop sampling after this time, but not before each pixel has a sample",
    )
    add(
        "--strategy",
        metavar="EXPR",
        type=_strategy,
        help="how directions are chosen: uniform, cosine, bsdf, light, a mixture such as "
        '"0.5 cosine + 0.5 light", or "mis(bsdf, light)" (the default)',
    )
    add("--sampler", metavar="NAME", type=_sampler, default="sobol", help="sobol (default) or independent")
    add(
        "--max-depth",
        metavar="N",
        type=_depth,
        help="longest path in edges: 1 emitters only, 2 direct light, -1 unbounded (default: the scene's)",
    )
    add("--size", metavar="WxH", type=_size, help="pixels, such as 640x360 (default: the scene's)")
    add("--seed", metavar="N", type=_integer(0, 2**64 - 1), default=0, help="another seed, another noise")
    add(
        "--threads",
        metavar="N",
        type=_integer(1, _internal.MAX_THREADS),
        help="threads (default: all available cores); the image does not depend on it",
    )
    add("--exposure", metavar="EV", type=_stops, default=0.0, help="brightens a .png by 2^EV")
    add("--tone", choices=_internal.tones(), default="srgb", help="tone curve of a .png (default: srgb)")
    add("--quiet", action="store_true", help="no progress and no summary; warnings and errors remain")
    add("--json", action="store_true", help="print one JSON object on standard output instead of the summary")


def _add_info(commands: argparse._SubParsersAction[_Parser]) -> None:
    parser = commands.add_parser(
        "info",
        help="say what is in a scene",
        description="Loads SCENE and says what is in it.",
        allow_abbrev=False,
    )
    _add_scene(parser)
    _add_environment(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object on standard output")


def _add_convert(commands: argparse._SubParsersAction[_Parser]) -> None:
    parser = commands.add_parser(
        "convert",
        help="write a scene in the format of another renderer",
        description="Writes SCENE as OUT, in the format that its name ends with: .xml (Mitsuba 3), "
        ".pbrt (pbrt-v4), .gltf or .glb (glTF 2.0). Meshes and images go to a folder beside it. "
        "What the format cannot say is said, with what is written instead. Succeeds only if all was written.",
        epilog=CONVERT_EXAMPLES,
        formatter_class=_Wrapped,
        allow_abbrev=False,
    )
    _add_scene(parser)
    add = parser.add_argument
    add("output", metavar="OUT", help="the file to write; its folder has to be there")
    add(
        "--own-plugins",
        action="store_true",
        help="XML may name what Steradian has and Mitsuba has not, which Mitsuba does not read then; "
        "otherwise the nearest that Mitsuba has is written",
    )
    add("--force", action="store_true", help="overwrite files, but never those that the scene is read from")
    add("--threads", metavar="N", type=_integer(1, _internal.MAX_THREADS), help="threads (default: all)")
    add("--quiet", action="store_true", help="no summary; warnings and errors remain")
    add("--json", action="store_true", help="print one JSON object on standard output instead of the summary")


def _add_article(commands: argparse._SubParsersAction[_Parser]) -> None:
    parser = commands.add_parser(
        "article",
        help="run the experiments of the article, and write a page with their results",
        description="Runs every experiment of an article on Monte Carlo integration, from π by throwing "
        "points to a rendered room, and writes one HTML page with code, plots and results. Succeeds only if "
        "every measured value is within its 99.9 % interval of the exact one, and every deliberate mistake "
        'was caught. Takes a minute or two, and needs Matplotlib: pip install "steradian[article]".',
        epilog=ARTICLE_EXAMPLES,
        formatter_class=_Wrapped,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("-o", "--output", metavar="FILE", default="article.html", help="the page (default: article.html)")
    add(
        "--seed",
        metavar="N",
        type=_integer(0, 2**32 - 1),
        default=1,
        help="another seed, other samples (default: 1)",
    )
    add("--quick", action="store_true", help="a sixteenth of the samples: seconds, larger errors")
    add("--open", action="store_true", help="show the page in a browser")
    add("--quiet", action="store_true", help="no progress and no summary; what does not hold is still said")


def _add_verify(commands: argparse._SubParsersAction[_Parser]) -> None:
    parser = commands.add_parser(
        "verify",
        help="check every building block: samplers against their densities, energy, reciprocity, …",
        description="Checks scattering models, lights, distributions, filters and scenes with known answers, "
        "with many parameters: that samples follow their density, that it integrates to one, that sample, "
        "eval and pdf agree, that nothing is out of reach, reciprocity, energy, white furnaces, and that "
        "nothing is ever NaN. Blocks that are wrong on purpose must be caught. Succeeds only if all holds.",
        epilog=VERIFY_EXAMPLES,
        formatter_class=_Wrapped,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("name", metavar="NAME", nargs="*", help="a group, a block, or part of a case's name (default: all)")
    add("--list", action="store_true", help="list the blocks, and how many cases each has")
    add("--html", metavar="FILE", help="write a page, with plots of what fails")
    add("--json", action="store_true", help="print one JSON object on standard output")
    add(
        "--seed",
        metavar="N",
        type=_integer(0, 2**32 - 1),
        default=1,
        help="another seed, other samples (default: 1)",
    )
    add(
        "--failure-rate",
        metavar="P",
        type=_probability,
        default=1e-3,
        help="how often a run may raise a false alarm (default: 0.001)",
    )
    add(
        "--threads",
        metavar="N",
        type=_integer(0, _internal.MAX_THREADS),
        default=0,
        help="threads (default: 0, all that there are)",
    )
    add("--quiet", action="store_true", help="no progress and no table; what fails is still said")


def _probability(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not between 0 and 1")
    return value


def _add_scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", help="a Mitsuba XML, pbrt-v4 or glTF 2.0 file, or an OBJ, PLY or STL mesh"
    )
    parser.add_argument(
        "--define",
        "-D",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        type=_definition,
        help="a value for $NAME in the scene file; may be repeated",
    )
    parser.add_argument(
        "--search-path",
        metavar="DIR",
        action="append",
        default=[],
        type=_folder,
        help="where to look for files that are neither beside the scene nor where it says; may be repeated",
    )
    parser.add_argument(
        "--variant",
        metavar="NAME",
        help="which of the scene's sets of materials is shown, where a glTF file has several",
    )
    parser.add_argument(
        "--limit",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        type=lambda text: _checked(lambda: parse_limit(text)),
        help="how much of a file is taken in, such as file_bytes=8G: docs/import.md lists the limits; "
        "may be repeated",
    )
    parser.add_argument("--strict", action="store_true", help="fail on warnings about the scene, too")


def _add_environment(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--environment",
        metavar="FILE",
        help="an image of latitude and longitude, .hdr or .exr, +Y up, to put around the scene",
    )


def _integer(low: int, high: int) -> Callable[[str], int]:
    def convert(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text} is not from {low} to {high}")
        return value

    return convert


def _depth(text: str) -> int:
    if text == "-1":
        return -1
    try:
        return _integer(1, 2**31 - 1)(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is neither a number of path edges, at least 1, nor -1 for no limit"
        ) from None


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None


def _seconds(text: str) -> float:
    seconds = _number(text)
    if not (seconds > 0.0 and math.isfinite(seconds)):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number of seconds")
    return seconds


def _stops(text: str) -> float:
    stops = _number(text)
    if not abs(stops) <= 100.0:
        raise argparse.ArgumentTypeError(f"{text} is not a number of stops from -100 to 100")
    return stops


def _size(text: str) -> tuple[int, int]:
    width, x, height = text.lower().partition("x")
    if not (x and width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 640x360")
    return int(width), int(height)


def _strategy(text: str) -> str:
    return _checked(lambda: str(strategy(text)))


def _sampler(text: str) -> str:
    return _checked(lambda: _internal.normalize_sampler(text))


def _checked(convert: Callable[[], T]) -> T:
    try:
        return convert()
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _folder(text: str) -> str:
    if not os.path.isdir(text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a folder")
    return text


def _definition(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form NAME=VALUE")
    return name, value

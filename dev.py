#!/usr/bin/env python3
"""Builds Steradian into .venv, and runs or tests it from there. The system's Python stays as it is.

    python3 dev.py render scenes/cornell-box.xml     build if need be, then: steradian render scenes/...
    python3 dev.py info scenes/cornell-box.xml       the same for any other steradian command
    python3 dev.py article --open                    run the experiments of an article, and show their page
    python3 dev.py build                             build only
    python3 dev.py test                              formatting, lints, types, documentation, all tests
    python3 dev.py test -k merge                     only Python's tests, with these arguments for pytest
    python3 dev.py instructions                      count instructions, compare them with the stored counts
    python3 dev.py bench --quick                     measure beside other renderers, see benches/README.md

Needs Rust (rustup.rs) and Python 3.11 or newer with pip; nothing else.
"""

import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"


def python_of(venv):
    """The interpreter of a virtual environment."""
    return venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


PYTHON = python_of(VENV)
STAMP = VENV / "steradian-built-from.txt"
SOURCES = (
    "crates",
    "python",
    "Cargo.toml",
    "Cargo.lock",
    "pyproject.toml",
    "rust-toolchain.toml",
    "README.md",
)
# Commands that are scripts of their own.
SCRIPTS = {"instructions": "benches/instructions.py", "bench": "benches/run.py"}
OLDEST_PYTHON = (3, 11)
# The last line of a test runner, such as "test result: ok. 12 passed" or "31 passed in 4.20s".
CLOSING_LINE = re.compile(
    r"^test result: |^=*\s*\d+ (passed|failed|skipped|error).* in [\d.:]+s|^no tests ran"
)


def main(arguments):
    """Does what the module's text says; returns the exit code."""
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if arguments else 2
    check_tools()
    if arguments[0] == "test":
        return test(arguments[1:])
    if arguments[0] in SCRIPTS:
        return run_ignoring_interrupts([sys.executable, str(ROOT / SCRIPTS[arguments[0]]), *arguments[1:]])
    for name in arguments[1:]:
        if name.endswith(".xml") and not Path(name).exists():
            # Said at once, and not after a build of some minutes.
            sys.exit(f"dev.py: there is no file {name}; our own scenes are in {ROOT / 'scenes'}")
    build()
    if arguments[0] == "build":
        return 0
    if arguments[0] == "article":
        install_extra("article")
    command = [str(PYTHON), "-m", "steradian", *arguments]
    if os.name == "posix":
        # The command takes this process's place, so that Ctrl-C reaches it alone.
        sys.stdout.flush()
        os.execv(command[0], command)
    return run_ignoring_interrupts(command)


def check_tools():
    """Ends with one sentence if something is missing that only the user can install."""
    if sys.version_info < OLDEST_PYTHON:
        found = "{}.{}".format(*sys.version_info)
        sys.exit(f"dev.py needs Python 3.11 or newer, and this is {found}; run it as: python3.11 dev.py")
    cargo_bin = Path.home() / ".cargo" / "bin"
    if shutil.which("cargo") is None:
        # rustup was installed in this very shell, which does not know it yet.
        os.environ["PATH"] += os.pathsep + str(cargo_bin)
    if shutil.which("cargo") is None:
        sys.exit(
            "dev.py needs Rust's cargo, which is not there; install it with rustup, see https://rustup.rs"
        )


def test(pytest_arguments):
    """Runs every check, or only pytest if it is given arguments; returns the exit code."""
    make_venv()
    closing_lines = []
    failed = []
    checks = [] if pytest_arguments else cargo_checks()
    for name, command, environment in checks:
        if not run_check(name, command, environment, closing_lines):
            failed.append(name)
    install_extra("test")
    for name, command in [] if pytest_arguments else python_checks():
        if not run_check(name, command, {}, closing_lines):
            failed.append(name)
    build()
    if not run_check("pytest", [str(PYTHON), "-m", "pytest", "-q", *pytest_arguments], {}, closing_lines):
        failed.append("pytest")
    heading("closing lines")
    print("\n".join(closing_lines))
    print(f"failed: {', '.join(failed)}" if failed else "all checks passed")
    return 1 if failed else 0


def cargo_checks():
    """(name, command, environment) of what Rust's tools check."""
    python = {"PYO3_PYTHON": str(PYTHON)}
    if os.environ.get("CI"):
        # Nothing is compiled twice there, and what a second time would need takes more room than the rest.
        python["CARGO_INCREMENTAL"] = "0"
    return [
        ("cargo fmt", ["cargo", "fmt", "--all", "--check"], {}),
        (
            "cargo clippy",
            ["cargo", "clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
            python,
        ),
        (
            "cargo doc",
            ["cargo", "doc", "--workspace", "--no-deps", "--locked"],
            {**python, "RUSTDOCFLAGS": "-D warnings"},
        ),
        ("cargo test", ["cargo", "test", "--workspace", "--locked", "--no-fail-fast"], python),
    ]


def python_checks():
    """(name, command) of what Python's tools check."""
    tool = [str(PYTHON), "-m"]
    return [
        ("ruff format", [*tool, "ruff", "format", "--check", "."]),
        ("ruff check", [*tool, "ruff", "check", "."]),
        ("mypy", [*tool, "mypy"]),
    ]


def run_check(name, command, environment, closing_lines):
    """Runs a command, shows what it says, keeps its closing lines; did it succeed?"""
    heading(name)
    start = time.monotonic()
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    for line in process.stdout:
        sys.stdout.write(line)
        sys.stdout.flush()
        if CLOSING_LINE.search(line) and not line.startswith(
            "test result: ok. 0 passed; 0 failed; 0 ignored"
        ):
            closing_lines.append(f"{name}: {line.strip().strip('= ')}")
    succeeded = process.wait() == 0
    closing_lines.append(f"{name}: {'ok' if succeeded else 'FAILED'}, {time.monotonic() - start:.0f} s")
    return succeeded


def heading(text):
    """Says what comes next."""
    print(f"\n== {text}", flush=True)


def build():
    """Installs the package into .venv, if its sources have changed since the last time."""
    make_venv()
    once(STAMP, source_hash(), "building; the first time takes some minutes", [str(ROOT)])


def install_extra(name):
    """Installs what pyproject.toml lists for tests, or for a command."""
    import tomllib

    with open(ROOT / "pyproject.toml", "rb") as file:
        wanted = tomllib.load(file)["project"]["optional-dependencies"][name]
    stamp = VENV / f"steradian-{name}-tools.txt"
    once(stamp, "\n".join(wanted), f"installing what the {name} needs", wanted)


def once(stamp, wanted, what, requirements, python=PYTHON):
    """Installs for ``python``, unless ``stamp`` says that it was done for the same ``wanted``."""
    if stamp.exists() and stamp.read_text(encoding="utf-8") == wanted:
        return
    say(what)
    stamp.unlink(missing_ok=True)
    run_quietly([*pip(python), "install", "--disable-pip-version-check", *requirements])
    stamp.write_text(wanted, encoding="utf-8")


def make_venv(venv=VENV):
    """Makes an environment unless there is one that works."""
    python = python_of(venv)
    if python.exists() and subprocess.run([str(python), "-c", ""], capture_output=True).returncode == 0:
        return
    command = [sys.executable, "-m", "venv", "--clear", str(venv)]
    if importlib.util.find_spec("ensurepip") is None:
        # Debian ships ensurepip apart: this interpreter's pip then serves the environment as well.
        if importlib.util.find_spec("pip") is None:
            sys.exit("dev.py needs pip, which this Python lacks (Debian, Ubuntu: apt install python3-venv)")
        command.append("--without-pip")
    say(f"making {venv.name}")
    run_quietly(command)


def pip(python=PYTHON):
    """The pip that installs for ``python``."""
    if subprocess.run([str(python), "-c", "import pip"], capture_output=True).returncode == 0:
        return [str(python), "-m", "pip"]
    return [sys.executable, "-m", "pip", "--python", str(python)]


def source_hash():
    """Of the names and contents of everything that the package is built from."""
    digest = hashlib.sha256()
    for name in SOURCES:
        top = ROOT / name
        files = sorted(top.rglob("*")) if top.is_dir() else [top]
        for path in files:
            if (
                path.is_file()
                and path.suffix not in (".pyc", ".so", ".pyd")
                and "__pycache__" not in path.parts
            ):
                digest.update(f"{path.relative_to(ROOT).as_posix()}\0".encode())
                digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def run_quietly(command):
    """Runs a command; shows what it said, and ends, only if it failed."""
    done = subprocess.run(
        command,
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode != 0:
        sys.stderr.write(done.stdout)
        sys.exit(f"failed: {' '.join(command)}")


def run_ignoring_interrupts(command):
    """Runs a command that answers Ctrl-C itself; returns its exit code."""
    with subprocess.Popen(command) as process:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:
                continue


def say(text):
    """To standard error: standard output belongs to the command that runs."""
    print(f"dev.py: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)

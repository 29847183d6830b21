"""The command ``steradian``: arguments in, files, a report and an exit code out.

Exit codes: 0 done, 1 it failed, 2 the command line makes no sense, 130 Ctrl-C (what was there is written).
Whatever goes wrong is one message on standard error; nothing is half-written.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from steradian.cli.arguments import parse
from steradian.cli.article import article
from steradian.cli.convert import convert
from steradian.cli.info import info
from steradian.cli.render import render
from steradian.cli.verify import verify

FAILED = 1
INTERRUPTED = 130
BROKEN_PIPE = 141


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command line and returns its exit code."""
    try:
        code = _run(argv)
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        # The reader has gone; keep the interpreter from flushing into nothing at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BROKEN_PIPE
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return INTERRUPTED


def _run(argv: Sequence[str] | None) -> int:
    arguments = parse(argv)
    commands = {"render": render, "info": info, "convert": convert, "article": article, "verify": verify}
    command = commands[arguments.command]
    try:
        return command(arguments)
    except BrokenPipeError:
        raise
    except (OSError, ValueError, MemoryError) as error:
        print(f"error: {_message(error)}", file=sys.stderr)
        return FAILED


def _message(error: Exception) -> str:
    if isinstance(error, MemoryError) and not str(error):
        return "out of memory"
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)

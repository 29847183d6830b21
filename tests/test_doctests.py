"""Examples in docstrings run, and every public name has one."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import steradian

# Their examples would render for seconds, or need a file; README's commands and other tests run them.
WITHOUT_EXAMPLE = {
    "Diagnostic",
    "IntegrationProgress",
    "Progress",
    "Result",
    "Samples",
    "Scene",
    "load",
    "render",
}


def modules():
    """Every module of the package but the command line's entry."""
    names = [m.name for m in pkgutil.walk_packages(steradian.__path__, "steradian.")]
    return ["steradian", *(name for name in names if not name.endswith(("__main__", "_internal")))]


@pytest.mark.parametrize("name", modules())
def test_examples_run(name):
    result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert result.failed == 0


def test_some_examples_are_found():
    attempted = sum(doctest.testmod(importlib.import_module(name)).attempted for name in modules())
    assert attempted > 40


def public():
    """(name, object) of what users import that is a function or a class."""
    names = [name for name in steradian.__all__ if not name.startswith("__")]
    objects = [(name, getattr(steradian, name)) for name in names]
    return [(name, value) for name, value in objects if inspect.isfunction(value) or inspect.isclass(value)]


@pytest.mark.parametrize(("name", "value"), public())
def test_public_names_are_documented(name, value):
    assert inspect.getdoc(value), name
    is_error = inspect.isclass(value) and issubclass(value, BaseException)
    if not is_error and name not in WITHOUT_EXAMPLE:
        assert ">>> " in value.__doc__, f"{name} has no example"

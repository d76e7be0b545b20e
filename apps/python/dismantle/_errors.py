"""Exceptions: broken input, configuration or plugins. How a search ended is a value (Outcome), never an exception."""
from typing import NamedTuple


class Diagnostic(NamedTuple):
    """One thing wrong with a configuration. line and column count from 1; 0 = unknown."""

    file: str
    line: int
    column: int
    message: str


class Error(Exception):
    """Base of all errors that Dismantle raises on purpose."""


class InputError(Error):
    """Unusable input. `subject`: the file or part; the message says where in it, as far as that is known."""

    subject = ""


class ConfigError(Error):
    """Everything that is wrong with a configuration, each line as file:line:column: error: message. `diagnostics`: the same
    as a list of Diagnostic."""

    diagnostics: list = []


class PluginError(Error):
    """A plugin that cannot be loaded or made. `file`: the file that it is in."""

    file = ""

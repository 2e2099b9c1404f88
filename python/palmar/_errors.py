# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong, by the kinds of the command line's exit codes (docs/using/exit-codes.md)."""


class Error(Exception):
    """Root of what Palmar raises on purpose. The message names the object, the value with its unit
    and what is allowed."""

    exit_code = 1


class UsageError(Error, ValueError):
    """An argument or setting is outside what is allowed."""

    exit_code = 2


class InputError(Error, ValueError):
    """An input file is missing, unreadable, broken, or its unit can't be decided."""

    exit_code = 3


class NumericalError(Error, ArithmeticError):
    """A numerical method found no answer, or there is none."""

    exit_code = 4


class CheckFailed(Error):
    """A stated check failed."""

    exit_code = 5


class ProgramMissing(Error):
    """An optional program that the task calls is not installed."""

    exit_code = 6


class OutputError(Error, OSError):
    """A result can't be written."""

    exit_code = 1


class Cancelled(Error):
    """The task was asked to stop. Ctrl-C is a KeyboardInterrupt, not this."""

    exit_code = 130

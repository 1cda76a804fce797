"""The engine's reports, taken apart for the margin of a text."""

from __future__ import annotations

import re

import msgspec

_HEAD = re.compile(r"(?P<file>.+?):(?P<line>\d+):(?P<column>\d+): (?P<message>.*)")
_MARKED = re.compile(r" +\| +(\^+)")
_HELP = re.compile(r" +=\s(.*)")


class Problem(msgspec.Struct):
    """Something wrong or doubtful in a text."""

    severity: str
    """error or warning."""
    message: str
    line: int = 1
    """Counts from 1, as columns do."""
    column: int = 1
    width: int = 0
    """Characters that are meant; 0 for the whole line."""
    help: str = ""
    """What might mend it."""


def problems(report: str, file: str, severity: str) -> list[Problem]:
    """Return the problems of a report of the engine, which may hold several.

    Those of another file (an included one) are told at the first line, with their own place.
    """
    found: list[Problem] = []
    for line in report.splitlines():
        if head := _HEAD.fullmatch(line):
            place, message = int(head["line"]), head["message"]
            if head["file"] == file:
                found.append(Problem(severity, message, place, int(head["column"])))
            else:
                found.append(Problem(severity, line))
        elif found and (mark := _MARKED.fullmatch(line)):
            found[-1].width = len(mark[1])
        elif found and (words := _HELP.fullmatch(line)):
            found[-1].help = words[1]
    return found or [Problem(severity, report)]

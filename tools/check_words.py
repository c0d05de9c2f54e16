#!/usr/bin/env python3
"""Looks for words of the project's former dialect, for which the field has standard terms.

usage: check_words.py [ROOT]

Reports each as file:line, in whatever case, and file names that contain one. docs/glossary.md and CHANGELOG.md may contain them. Only
unambiguous words are listed.
"""
import re
import sys

from listed_problems import report

WORDS = {
    r"WhereAmI": "localization stage",
    r"WhereIsTheLamp": "lamp estimation stage",
    r"WhatIsShaded": "shadow mask stage",
    r"KnownSelf": "localization setup",
    r"Whereabouts": "robot pose estimate",
    r"FloorBelief": "planar pose estimate",
    r"\bname_of\b": "to_string()",
    r"\bby_(?:pose|tip)\b": "jacobian with respect to pose, to tip",
    r"\bheard\(\)": "on_odometry(), on_switch_ack()",
    r"\bown pixels\b": "self-mask",
    r"\bis is not known\b": "unknown, as in 'robot pose unknown'",
    r"\bcovariance is none\b": "covariance is not positive definite",
    r"\bwhat is not is passed by\b": "other messages are ignored",
    r"\btelling_\w+|(?:\.|->|::)telling\b": "information weight",
}
PATTERN = re.compile("|".join(f"({words})" for words in WORDS), re.IGNORECASE)
SUFFIXES = {".h", ".cpp", ".py", ".md", ".toml", ".txt", ".cmake", ".sh"}
EXEMPT = {"docs/glossary.md", "CHANGELOG.md", "tools/check_words.py", "tests/tools/check_words_test.py"}


def is_text(file):
    """Sources, pages, and scripts that have no suffix."""
    if file.suffix in SUFFIXES:
        return True
    if file.suffix or not file.is_file():
        return False
    with file.open("rb") as content:
        return content.read(2) == b"#!"


def words_in(text):
    for match in PATTERN.finditer(text):
        yield f"'{match.group()}': expected {list(WORDS.values())[match.lastindex - 1]}"


def problems(root):
    for file in sorted(root.rglob("*")):
        path = file.relative_to(root).as_posix()
        if path.startswith(("build/", "out/", ".git/")) or path in EXEMPT or not is_text(file) or not file.is_file():
            continue
        for problem in words_in(path.replace("_", " ")):
            yield f"{path}: the file's name: {problem}"
        for number, line in enumerate(file.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            for problem in words_in(line):
                yield f"{path}:{number}: {problem}"


if __name__ == "__main__":
    sys.exit(report(problems))

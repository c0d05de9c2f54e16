#!/usr/bin/env python3
"""Looks for words of the project's former dialect, for which the field has standard terms.

usage: check_words.py [ROOT]

Reports each as file:line. docs/glossary.md and CHANGELOG.md may contain them. Only unambiguous words are listed.
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
}
PATTERN = re.compile("|".join(f"({words})" for words in WORDS))
SUFFIXES = {".h", ".cpp", ".py", ".md", ".toml", ".txt", ".cmake", ".sh"}
EXEMPT = {"docs/glossary.md", "CHANGELOG.md", "tools/check_words.py", "tests/tools/check_words_test.py"}


def problems(root):
    for file in sorted(root.rglob("*")):
        path = file.relative_to(root).as_posix()
        if path.startswith(("build/", "out/", ".git/")) or path in EXEMPT or file.suffix not in SUFFIXES or not file.is_file():
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            for match in PATTERN.finditer(line):
                yield f"{path}:{number}: '{match.group()}': expected {list(WORDS.values())[match.lastindex - 1]}"


if __name__ == "__main__":
    sys.exit(report(problems))

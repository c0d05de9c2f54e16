#!/usr/bin/env python3
"""Lists the headers of the chapters' rooms whose comments cite nothing, and citations of what the dissertation does not have.

usage: check_citations.py [ROOT]

A citation is an equation, algorithm, figure, table or section of the dissertation, a paper, or the word Ours for what is this project's own:
Eq. 3.1, Alg. 4.1, Fig. 5.1, Table 5.1, (3.1.2), section 6.4.1.1, (Canny 1986), Ours.
"""
import re
import sys

from listed_problems import report

ROOMS = [f"pipeline/{room}" for room in
         ("color", "localization", "illumination", "render", "shade", "behavior", "imaging", "geometry", "motion", "stages",
          "calibration", "world", "person")]
# What chapters 2 to 6 of the dissertation number, by the first letters of its name in a citation.
NUMBERED = {
    "eq": "3.1 3.2 4.1 4.2 4.3 4.4 4.5 5.1 5.2",
    "alg": "2.1 3.1 3.2 4.1 5.1 5.2 6.1",
    "fig": "2.1 2.2 2.3 2.4 2.5 3.1 3.2 3.3 3.4 3.5 4.1 4.2 4.3 4.4 4.5 4.6 4.7 4.8 4.9 5.1 5.2 5.3 5.4 5.5 "
           "6.1 6.2 6.3 6.4 6.5 6.6 6.7 6.8 6.9 6.10",
    "tab": "2.1 4.1 4.2 5.1 6.1",
    "sec": "2.1 2.2 2.3 2.4 2.5 2.6 2.6.1 2.6.1.1 2.6.1.2 2.6.2 2.6.2.1 2.6.2.2 3.1 3.1.1 3.1.2 3.2 3.2.1 3.2.2 3.3 3.3.1 3.3.2 3.4 "
           "4.1 4.2 4.3 4.3.1 4.3.2 4.3.3 4.4 5.1 5.2 5.3 5.4 5.4.1 5.4.2 5.4.3 5.5 "
           "6.1 6.2 6.2.1 6.2.2 6.2.3 6.2.4 6.3 6.3.1 6.4 6.4.1 6.4.1.1 6.4.1.2 6.4.2 6.4.3 6.5",
}
KINDS = {letters: set(numbers.split()) for letters, numbers in NUMBERED.items()}
NUMBER = r"([2-6]\.\d+(?:\.\d+)*)"
NAMED = re.compile(rf"\b((?:Eq|Alg|Fig)\.|Equation|Algorithm|Figure|Table|[Ss]ection) {NUMBER}")
IN_PARENTHESES = re.compile(rf"\((?:[A-Za-z' -]+, )?{NUMBER}(?=[),:;'])")  # (3.1.2), (5.2, line 3), (the shadow volumes, 2.5)
PAPER = re.compile(r"\([^()]*\b[A-Z][\w'-]+(?: et al\.)?,? (?:18|19|20)\d\d\b")
COMMENT = re.compile(r"//[/<! ]*(.*)")


def comment_lines(file):
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        match = COMMENT.search(line)
        if match:
            yield number, match.group(1).strip()


def numbered(text):
    """The kind, number and text of each citation of the dissertation."""
    for match in NAMED.finditer(text):
        kind = match.group(1).lower()
        yield next(letters for letters in KINDS if kind.startswith(letters)), match.group(2), match.group()
    for match in IN_PARENTHESES.finditer(text):
        yield "sec", match.group(1), f"({match.group(1)})"


def problems_of(file):
    lines = list(comment_lines(file))
    for line, text in lines:
        for kind, number, words in numbered(text):
            if number not in KINDS[kind]:
                yield line, f"the dissertation has no {words}"
    text = " ".join(words for _, words in lines)  # a citation may be broken across two lines
    cited = any(number in KINDS[kind] for kind, number, _ in numbered(text))
    if not cited and not PAPER.search(text) and not re.search(r"\bOurs\b", text):
        yield 1, "no citation: expected Eq. N.N, Alg. N.N, Fig. N.N, Table N.N, (N.N), section N.N, (Name YEAR) or Ours"


def problems(root):
    for room in ROOMS:
        for file in sorted((root / room).rglob("*.h")):
            for line, words in problems_of(file):
                yield f"{file.relative_to(root).as_posix()}:{line}: {words}"


if __name__ == "__main__":
    sys.exit(report(problems))

#!/usr/bin/env python3
"""Says which files of a target may be compiled as one: those whose local names do not clash.

usage: unity_groups.py LIST

LIST holds a line "target|file" per source file. Prints a line "target|group|file|file..." per group of at least two files. The names
that count are those declared in an anonymous namespace at the start of a line, as clang-format leaves them; they clash with each other and
with the types, constants and inline functions of the headers that the others include.
"""
import functools
import pathlib
import re
import sys
from collections import defaultdict

MOST_LINES = 1200  # of a group: enough to share the headers' cost, little enough to keep two processors busy

# How a line that declares something for the file alone begins. The name is the first group.
ALIAS = re.compile(r"(?:using|namespace) (?:namespace )?(?:\w+::)*(\w+)(?: = [^;]*)?;")
TYPE = re.compile(r"(?:template <.*> )?(?:struct|class|enum class|enum|union|using) (\w+)")
CONSTANT = re.compile(r"(?:static |inline |thread_local )*(?:constexpr|const|std::atomic).*?(\w+)(?:\[\w*\])*(?: = |\{|;)")
TEST = re.compile(r"((?:TEST(?:_F|_P)?|INSTANTIATE_TEST_SUITE_P)\(\w+, \w+)")
FUNCTION = re.compile(r"[\w:<>,&*\[\] ]*?(\w+)\(")
ENUMERATORS = re.compile(r"enum (?!class)[^{;]*\{([^}]*)\}")  # an unscoped enumeration's are names of the namespace
INNER_TYPE = re.compile(r"^ +(?:struct|class|enum class|enum) (\w+)[^;()]*\{", re.M)  # would shadow another file's type


INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)
PUBLIC = re.compile(r"^(?:(?:struct|class|enum class) (\w+)(?:;| \{| :| final)|inline [^(={\n]*?(\w+)(?:\(| =|\{|\[))", re.M)
ROOT = pathlib.Path(__file__).resolve().parents[1]


@functools.cache
def headers_of(path):
    """The project's headers that a file includes, directly or not."""
    found = set()
    for name in INCLUDE.findall(path.read_text()):
        header = ROOT / name
        if header.exists():
            found |= {header} | headers_of(header)
    return found


@functools.cache
def public_names_of(header):
    return {name for names in PUBLIC.findall(header.read_text()) for name in names if name}


def local_names(text):
    """{name: declaration} of what the file declares for itself, in its anonymous namespaces."""
    found = {}
    for block in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.M | re.S):
        for line in block.splitlines():
            if line[:1] in ("", " ", "}", "/", "#", ")", "{") or line.startswith("static_assert"):
                continue
            alias = ALIAS.match(line)
            match = alias or TEST.match(line) or TYPE.match(line) or CONSTANT.match(line) or FUNCTION.match(line)
            if match:
                found[match.group(1)] = line if alias else ""
        for names in ENUMERATORS.findall(block):
            found.update((name, "") for name in re.findall(r"\bk[A-Z]\w*", names))
    found.update((name, "") for name in INNER_TYPE.findall(text))
    return found


def clash(ours, theirs):
    """Whether a name means two things. The same alias may be declared twice."""
    return any(name in theirs and not (line and theirs[name] == line) for name, line in ours.items())


def groups_of(files):
    """Puts every file into the first group that has room and no name of its own."""
    groups = []  # [names, public names, lines, files]
    for file in files:
        path = pathlib.Path(file)
        text = path.read_text()
        if "\n#define " in text:  # tells a header something, or would go on to the next file
            continue
        names, lines = local_names(text), text.count("\n")
        public = set().union(*map(public_names_of, headers_of(path)))
        for group in groups:
            fits = not clash(names, group[0]) and not public & set(group[0]) and not group[1] & set(names)
            if group[2] + lines <= MOST_LINES and fits:
                group[0].update(names)
                group[1] |= public
                group[2] += lines
                group[3].append(file)
                break
        else:
            groups.append([names, public, lines, [file]])
    return [group[3] for group in groups]


def main():
    targets = defaultdict(list)
    for line in pathlib.Path(sys.argv[1]).read_text().splitlines():
        target, file = line.split("|")
        targets[target].append(file)
    for target, files in targets.items():
        for number, group in enumerate(groups_of(files)):
            if len(group) > 1:
                print("|".join([target, f"{target}_{number}", *group]))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes the files that a machine that builds everything from nothing compiles: each includes several files of one target.

usage: unity_groups.py LIST FOLDER

LIST holds a line "target|folder of the target|file" per source file. Writes FOLDER/TARGET_N.cpp for every group of at least two files, and prints a line
"target|group file|file|file..." for each. A group's file includes the headers of all its files first, so that the headers are read as they are. A
name of an anonymous namespace that another file of the group, or a header, has as well is another one while its file is read: by a macro.
Names that count are declared at the start of a line, as clang-format leaves them.
"""
import functools
import pathlib
import re
import sys
from collections import Counter, defaultdict

MOST_LINES = 2500  # of a group: enough to share the headers' cost, little enough to keep two processors busy

# How a line that declares something for the file alone begins. The name is the first group.
ALIAS = re.compile(r"(?:using|namespace) (?:namespace )?(?:\w+::)*(\w+)(?: = [^;]*)?;")
TYPE = re.compile(r"(?:template <.*> )?(?:struct|class|enum class|enum|union|using) (\w+)")
CONSTANT = re.compile(r"(?:static |inline |thread_local )*(?:constexpr|const|std::atomic).*?(\w+)(?:\[\w*\])*(?: = |\{|;)")
TEST = re.compile(r"((?:TEST(?:_F|_P)?|INSTANTIATE_TEST_SUITE_P)\(\w+, \w+)")
FUNCTION = re.compile(r"[\w:<>,&*\[\] ]*?(\w+)\(")
ENUMERATORS = re.compile(r"enum (?!class)[^{;]*\{([^}]*)\}")  # an unscoped enumeration's are names of the namespace
INNER_TYPE = re.compile(r"^ +(?:struct|class|enum class|enum) (\w+)(?: final)?(?: : [^;(){]*)? \{", re.M)  # would shadow another file's type


INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)
ANY_INCLUDE = re.compile(r'^#include [<"].*[>"]', re.M)
PUBLIC = re.compile(r"^(?:(?:struct|class|enum class) (\w+)(?:;| \{| :| final)|inline [^(={\n]*?(\w+)(?:\(| =|\{|\[))", re.M)
ROOT = pathlib.Path(__file__).resolve().parents[1]
FOUND_BY_OTHERS = {"PrintTo", "to_string", "describe", "main", "swap", "begin", "end"}  # templates look for these by their names


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


def code_of(text):
    """The text without comments and literals."""
    return re.sub(r'//.*|"(?:[^"\\\n]|\\.)*"', "", text)


@functools.cache
def words_of(header):
    return set(re.findall(r"\w+", code_of(header.read_text())))


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
        found.update((name, "") for name in re.findall(r"\bk[A-Z]\w*(?= = )", block))
    found.update((name, "") for name in INNER_TYPE.findall(text))
    return found


class File:
    def __init__(self, name):
        self.path = pathlib.Path(name)
        self.text = self.path.read_text()
        self.lines = self.text.count("\n")
        self.words = set(re.findall(r"\w+", code_of(self.text)))
        self.locals = local_names(self.text)
        self.headers = headers_of(self.path)
        self.public = set().union(*map(public_names_of, self.headers))

    @property
    def stands_alone(self):
        """Tells a header something, or includes some otherwise than as they are."""
        return re.search(r'^(?:#(?:define|if)|extern "C")', self.text, re.M) is not None

    @functools.cache
    def can_rename(self, name):
        """Whether every occurrence of a local name in the file means what the file declares."""
        elsewhere = re.search(r"(?:::|\.|->)\s*%s\b" % re.escape(name), self.text)
        return (name.isidentifier() and name not in FOUND_BY_OTHERS and not elsewhere
                and not any(name in words_of(header) for header in self.headers))


class Group:
    def __init__(self):
        self.files, self.renamed = [], []  # of each file, the names that have to be others
        self.lines = 0

    def add(self, file):
        """Takes the file, if there is room and names that clash can be renamed. Returns whether it did."""
        if self.files and self.lines + file.lines > MOST_LINES:
            return False
        ours, theirs = set(), [set() for _ in self.files]
        for i, other in enumerate(self.files):
            for name, declaration in file.locals.items():
                same = name in other.locals and not (declaration and other.locals[name] == declaration)
                if (same and name not in self.renamed[i]) or name in other.public:
                    ours.add(name)
            # A name that the file uses for something else, a variable of a function, say, would be shadowed.
            theirs[i] |= {name for name, declaration in other.locals.items()
                          if name not in file.locals and (name in file.public or (name in file.words and not declaration))}
        if not all(map(file.can_rename, ours)):
            return False
        if not all(other.can_rename(name) for other, names in zip(self.files, theirs) for name in names):
            return False
        for names, more in zip(self.renamed, theirs):
            names |= more
        self.files.append(file)
        self.renamed.append(ours)
        self.lines += file.lines
        return True

    def text(self):
        includes = dict.fromkeys(line for file in self.files for line in ANY_INCLUDE.findall(file.text))
        lines = ["// Written by cmake/unity_groups.py.", *includes]
        for file, names in zip(self.files, self.renamed):
            suffix = file.path.stem
            lines += [f"#define {name} {name}_in_{suffix}" for name in sorted(names)]
            lines.append(f'#include "{file.path}"')
            lines += [f"#undef {name}" for name in sorted(names)]
        return "\n".join(lines) + "\n"


def groups_of(names):
    """Puts every file into the first group that takes it."""
    groups = []
    for file in map(File, names):
        if file.stands_alone:
            continue
        for group in groups:
            if group.add(file):
                break
        else:
            groups.append(Group())
            groups[-1].add(file)
    return groups


def write(path, text):
    """Leaves a file as it is that holds the text: what was made from it is not made again."""
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def main():
    targets = defaultdict(list)
    lines = [line.split("|") for line in pathlib.Path(sys.argv[1]).read_text().splitlines()]
    uses = Counter((folder, file) for _, folder, file in lines)
    for target, folder, file in lines:
        # That a file is compiled as part of a group is known of a folder, not of a target: one of two targets there is compiled for each.
        if uses[folder, file] == 1:
            targets[target].append(file)
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(exist_ok=True)
    for target, files in targets.items():
        for number, group in enumerate(groups_of(files)):
            if len(group.files) > 1:
                path = folder / f"{target}_{number}.cpp"
                write(path, group.text())
                print("|".join([target, str(path), *(str(file.path) for file in group.files)]))


if __name__ == "__main__":
    main()

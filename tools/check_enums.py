#!/usr/bin/env python3
"""Looks for enums that cannot be printed: every public enum class of a header has a to_string() in a header.

usage: check_enums.py [ROOT]

Reports each without one as file:line. Enums of a class's private part and those of a .cpp are nobody's to print. EXCEPTIONS says which
public ones have none, and why; one that is gone or has a to_string() is reported too.
"""
import re
import sys

from listed_problems import report

TOPS = ("pipeline", "platform", "hal", "src", "tools")
EXCEPTIONS = {
    "hal/sim/people/body.h: Cover": "an index into a person's materials",
    "hal/sim/scene/figure.h: JointDrive": "which formula moves a joint of the simulator's bodies",
    "pipeline/color/track/local_tracker.h: LocalTracker::Colors": "an argument of one function",
    "pipeline/render/sphere_groups.h: Preference": "an argument of a constructor",
    "platform/description.h: Field::Kind": "which member of a field holds its value",
    "platform/ring.h: Overflow": "a template argument",
    "src/sinks/mcap_records.h: McapOpcode": "bytes of the file format",
    "tools/lab/ours.h: Start": "an argument of two functions",
}
ENUM = re.compile(r"^( *)enum class (\w+)[^;]*?\{", re.MULTILINE)
SCOPE = re.compile(r"^( *)(class|struct) (\w+)[^;]*?\{|^ *(public|protected|private):", re.MULTILINE)
TO_STRING = re.compile(r"^[ \w]*std::string_view to_string\(([\w:]+) \w+\)", re.MULTILINE)


def enclosing(text, enum):
    """The class around a nested enum, and whether the enum is public there."""
    name, public = "", True
    for scope in SCOPE.finditer(text, 0, enum.start()):
        if scope.group(4):
            public = scope.group(4) == "public"
        elif len(scope.group(1)) < len(enum.group(1)):
            name, public = scope.group(3), scope.group(2) == "struct"
    return name, public


def public_enums(text):
    """Line and name, Class::Enum where it is nested, of each."""
    for enum in ENUM.finditer(text):
        name, public = enum.group(2), True
        if enum.group(1):
            outer, public = enclosing(text, enum)
            name = f"{outer}::{name}"
        if public:
            yield text.count("\n", 0, enum.start()) + 1, name


def room_of(path):
    """hal, hal/rmp, hal/sim: where the words of hal/sim/home may be those of an enum of hal/sim/base."""
    return tuple(path.split("/")[:-1][:2])


def problems(root):
    headers = {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
               for top in TOPS for path in sorted((root / top).rglob("*.h"))}
    printed = {(room_of(path), name) for path, text in headers.items() for name in TO_STRING.findall(text)}
    unused = {key for key in EXCEPTIONS if key.split(":")[0] in headers}
    for path, text in headers.items():
        for line, name in public_enums(text):
            if (room_of(path), name) in printed:
                continue
            if f"{path}: {name}" in EXCEPTIONS:
                unused.discard(f"{path}: {name}")
                continue
            yield f"{path}:{line}: enum class {name}: expected std::string_view to_string({name}) in a header of its room"
    for key in sorted(unused):
        yield f"tools/check_enums.py: the exception '{key}' is no longer one: there is no such enum, or it has a to_string()"


if __name__ == "__main__":
    sys.exit(report(problems))

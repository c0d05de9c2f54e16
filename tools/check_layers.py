#!/usr/bin/env python3
"""Holds every #include line to the arrows of docs/architecture.md.

usage: check_layers.py [ROOT]

A room may include itself and the rooms its row names, nothing else of the project's. The table below is the only place
where an arrow is written down for the machine; a new room needs a row.
"""
import pathlib
import re
import sys

HAL_INTERFACES = "hal"                     # hal/*.h
COLOR = [f"pipeline/color/{room}" for room in ("learn", "search", "track", "ball")]  # each may include those before it
CHAPTERS = [*COLOR, "pipeline/localization", "pipeline/illumination", "pipeline/person"]
ALLOWED = {
    "cmake": [],  # others' headers alone
    "platform": [],
    "platform/config": ["platform"],
    HAL_INTERFACES: ["platform"],
    "hal/replay": [HAL_INTERFACES, "platform"],
    "hal/dummy": [HAL_INTERFACES, "platform"],
    "hal/v4l2": [HAL_INTERFACES, "platform"],
    "hal/gpiod": [HAL_INTERFACES, "platform"],
    "hal/socketcan": [HAL_INTERFACES, "platform"],
    "hal/rmp": [HAL_INTERFACES, "platform"],
    "hal/sim": [HAL_INTERFACES, "platform", "platform/config"],  # worlds are files
    "pipeline/runtime": ["platform"],
    "pipeline/imaging": ["platform"],
    "pipeline/geometry": ["platform"],
    "pipeline/world": ["platform", "pipeline/geometry"],
    "pipeline/render": ["platform", "pipeline/geometry", "pipeline/world"],
    "pipeline/shade": ["platform", "pipeline/geometry", "pipeline/world", "pipeline/render"],
    **{room: ["platform", "pipeline/imaging", *COLOR[:i]] for i, room in enumerate(COLOR)},
    "pipeline/localization": ["platform", "pipeline/geometry", "pipeline/imaging", "pipeline/world", "pipeline/render"],
    "pipeline/global_localization": ["platform", "pipeline/geometry", "pipeline/world", "pipeline/render", "pipeline/localization"],
    "pipeline/illumination": ["platform", "pipeline/geometry", "pipeline/imaging", "pipeline/world", "pipeline/render"],
    "pipeline/person": ["platform", "pipeline/geometry", "pipeline/imaging", *COLOR],
    "pipeline/behavior": ["platform", "pipeline/geometry", "pipeline/world", *CHAPTERS],
    "pipeline/stages": ["platform", HAL_INTERFACES, "pipeline/runtime", "pipeline/geometry", "pipeline/imaging", "pipeline/world",
                        "pipeline/render", "pipeline/shade", "pipeline/behavior", "pipeline/global_localization", *CHAPTERS],
    "pipeline/motion": ["platform", HAL_INTERFACES, "pipeline/runtime", "pipeline/behavior"],
    "pipeline/calibration": ["platform", "pipeline/geometry", "pipeline/illumination", "pipeline/stages"],
    "pipeline/mapping": ["platform", "pipeline/geometry", "pipeline/world", "pipeline/render", "pipeline/localization"],
    # the loop of Figure 5.1: the files directly in pipeline/
    "pipeline": ["platform", HAL_INTERFACES, "pipeline/runtime", "pipeline/stages"],
}
# The rooms of the program see all of the above, and of each other what their rows name.
PROGRAM = {
    "src/plug_in": [],
    "src/scoring": [],
    "src/devices": [],
    "src/config": [],
    "src/output": [],
    "src/input": ["src/output"],
    "src/sinks": ["src/output"],
    "src/tasks": ["src/sinks"],
    "src/boot": ["src/config", "src/input", "src/output", "src/plug_in", "src/sinks", "src/tasks"],
    "src/commands": ["src/boot", "src/config", "src/devices", "src/input", "src/output", "src/plug_in", "src/scoring", "src/sinks"],
    "src": ["src/commands"],  # main.cpp
}
# The outermost rooms see everything, and nobody sees them.
OUTERMOST = ["tools/lab", "tools/map", "tools/sim", "tests", "docs/guides"]  # the last one holds the guides' examples
# A chapter knows no device, thread, clock or environment.
FORBIDDEN_IN_CHAPTERS = re.compile(r'^\s*#include\s+[<"](thread|mutex|condition_variable|fcntl\.h|unistd\.h|sys/|platform/(clock|thread|stop|service)\.h|hal/)')
PURE = ["pipeline/imaging", "pipeline/geometry", "pipeline/world", "pipeline/render", "pipeline/shade", "pipeline/behavior", "pipeline/mapping", "pipeline/global_localization", *CHAPTERS]
# Peers are linked by the lab alone; the simulator's truth is for tests, the lab and the simulator's own tools.
TRUTH_ROOMS = ["tests", "tools/lab", "tools/sim", "hal/sim"]
ONLY_IN = {"opencv2/tracking": ["tools/lab"], "hal/sim/truth.h": TRUTH_ROOMS, "hal/sim/render/truth_images.h": TRUTH_ROOMS,
           "hal/simulation.h": ["tests", "hal/sim", "src"]}  # it carries truth for reports: no loop may know it
INCLUDE = re.compile(r'^\s*#include\s+([<"])([^>"]+)[>"]')


def room_of(path):
    """The longest known room that holds the path (a header that is included, or a file that includes)."""
    parent = path.rsplit("/", 1)[0] if "/" in path else ""
    while parent:
        if parent in ALLOWED or parent in PROGRAM or parent in OUTERMOST:
            return parent
        parent = parent.rsplit("/", 1)[0] if "/" in parent else ""
    return None


def rooms_seen_from(room):
    if room == "tests":
        return [*ALLOWED, *PROGRAM, *OUTERMOST]
    if room in OUTERMOST:
        return [*ALLOWED, *PROGRAM]
    return [*ALLOWED, *PROGRAM[room]] if room in PROGRAM else ALLOWED.get(room, [])


def problems(root):
    files = sorted(p for pattern in ("*.h", "*.cpp") for p in root.rglob(pattern))
    for file in files:
        path = file.relative_to(root).as_posix()
        if path.startswith(("build/", "out/")):
            continue
        room = room_of(path)
        if room is None:
            yield f"{path}: lies in no known room; tools/check_layers.py needs a row for it"
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            target = match.group(2)
            for name, rooms in ONLY_IN.items():
                if target.startswith(name) and not any(path.startswith(r + "/") for r in rooms):
                    yield f"{path}:{number}: {target} may be included by {' and '.join(rooms)} only"
            if room in PURE and FORBIDDEN_IN_CHAPTERS.match(line):
                yield f"{path}:{number}: a chapter knows no device, thread or clock, but includes {target}"
            if match.group(1) != '"':
                continue
            if not (root / target).exists():
                yield f'{path}:{number}: "{target}" is not a path from the root'
                continue
            other = room_of(target)
            if other == room or other in rooms_seen_from(room):
                continue
            row = PROGRAM.get(room, ALLOWED.get(room, []))
            yield f"{path}:{number}: {room} may not include {target} (its row allows {', '.join(row) or 'nothing'})"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    root = root if root.is_dir() else root.parents[1]
    found = list(problems(root))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Runs clang-tidy on every source file of the release build, two at a time, and remembers clean files.

usage: check_tidy.py [PATTERN]      only files whose path contains PATTERN

A file is clean as long as it, every project header it includes (directly or not), its compile command and .clang-tidy are
the same bytes as when it last passed; the memory is build/tidy.json.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
MEMORY = ROOT / "build" / "tidy.json"
INCLUDE = re.compile(rb'^\s*#include\s+"([^"]+)"', re.M)


def closure(path, seen):
    """The project's files that `path` is made of."""
    if path in seen or not path.exists():
        return seen
    seen.add(path)
    for name in INCLUDE.findall(path.read_bytes()):
        closure(ROOT / name.decode(), seen)
    return seen


def fingerprint(entry):
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    digest.update(re.sub(r"\S*/ccache ", "", entry["command"]).encode())
    for path in sorted(closure(pathlib.Path(entry["file"]), set())):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def tidy(entry):
    run = subprocess.run(["clang-tidy-14", "--quiet", "-p", ROOT / "build" / "release", entry["file"]], capture_output=True, text=True)
    return entry, run.returncode, run.stdout


def main():
    pattern = sys.argv[1] if len(sys.argv) > 1 else ""
    commands = json.loads((ROOT / "build" / "release" / "compile_commands.json").read_text())
    memory = json.loads(MEMORY.read_text()) if MEMORY.exists() else {}
    todo = []
    for entry in commands:
        path = pathlib.Path(entry["file"])
        if ROOT not in path.parents or pattern not in str(path) or (ROOT / "build") in path.parents:
            continue
        if ROOT / "tests" in path.parents and not pattern:  # the compiler's warnings have to do for tests; by name they are checked too
            continue
        entry["mark"] = fingerprint(entry)
        entry["key"] = path.relative_to(ROOT).as_posix()
        if memory.get(entry["key"]) != entry["mark"]:
            todo.append(entry)
    print(f"{len(todo)} of {len(commands)} files changed since they were last clean")
    bad = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for entry, code, output in pool.map(tidy, todo):
            if code == 0 and "warning:" not in output:
                memory[entry["key"]] = entry["mark"]
                continue
            bad += 1
            print(output.replace(f"{ROOT}/", ""))
    MEMORY.write_text(json.dumps(memory, indent=1, sort_keys=True))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

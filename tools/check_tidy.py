#!/usr/bin/env python3
"""Runs clang-tidy, as many at a time as there are processors, and remembers clean files.

usage: check_tidy.py [--quick] [--all] [PATTERN]

What is looked at: files changed in the work tree and by the last commits, the newest first. Without the commits' history (a shallow clone),
another sixth of the files with each commit.

  --all     every file but the tests, for which the compilers' warnings have to do
  PATTERN   every file whose path contains it, tests too
  --quick   what runs on a robot only (not tools/), without the search along execution paths (clang-analyzer-*) and the dearest of the
            rest: a third of the time

A file is clean as long as it, every project header it includes (directly or not), its compile command and .clang-tidy are
the same bytes as when it last passed; the memory is build/tidy.json (build/tidy-quick.json).
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
# Beside the analyzer, the dearest checks by --enable-check-profile that the compilers' warnings half make up for.
QUICK = ("-clang-analyzer-*,-bugprone-reserved-identifier,-bugprone-stringview-nullptr,-bugprone-suspicious-string-compare,"
         "-bugprone-multiple-statement-macro,-bugprone-unused-return-value,-misc-unused-using-decls")
RECENT_COMMITS = 30
MOST_RECENT = 24  # files
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


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True).stdout


def recent(keys):
    """Those of the files that were changed, or whose header was: in the work tree, then by the last commits, newest first."""
    if git("rev-parse", "--is-shallow-repository").strip() == "true":
        head = git("rev-parse", "HEAD")
        return [key for key in keys if hashlib.sha256((head + key).encode()).digest()[0] % 6 == 0]
    changed = [line[3:] for line in git("status", "--porcelain").splitlines()]
    changed += git("log", f"-{RECENT_COMMITS}", "--format=", "--name-only").splitlines()
    sources = dict.fromkeys(str(pathlib.Path(name).with_suffix(".cpp")) for name in changed if name.endswith((".h", ".cpp")))
    return [source for source in sources if source in keys][:MOST_RECENT]


def tidy(entry, checks):
    run = subprocess.run(["clang-tidy-14", "--quiet", *checks, "-p", ROOT / "build" / "tidy", entry["file"]],
                         capture_output=True, text=True)
    return entry, run.returncode, run.stdout


def main():
    quick = "--quick" in sys.argv[1:]
    pattern = next((argument for argument in sys.argv[1:] if not argument.startswith("--")), "")
    checks = [f"--checks={QUICK}"] if quick else []
    memory_file = ROOT / "build" / ("tidy-quick.json" if quick else "tidy.json")
    # Single files' commands: the tests' builds may compile files in groups, with a header that means nothing to clang.
    subprocess.run(["cmake", "-S", ROOT, "--preset", "tidy"], check=True, stdout=subprocess.DEVNULL)
    commands = json.loads((ROOT / "build" / "tidy" / "compile_commands.json").read_text())
    memory = json.loads(memory_file.read_text()) if memory_file.exists() else {}
    todo = []
    seen = set()
    for entry in commands:
        path = pathlib.Path(entry["file"])
        if ROOT not in path.parents or pattern not in str(path) or (ROOT / "build") in path.parents:
            continue
        if ROOT / "tests" in path.parents and not pattern:  # the compiler's warnings have to do for tests; by name they are checked too
            continue
        if quick and ROOT / "tools" in path.parents and not pattern:
            continue
        entry["mark"] = fingerprint(entry)
        entry["key"] = path.relative_to(ROOT).as_posix()
        if quick and entry["key"] in seen:  # a file of two programs
            continue
        seen.add(entry["key"])
        if memory.get(entry["key"]) != entry["mark"]:
            todo.append(entry)
    unknown = len(todo)
    if "--all" not in sys.argv[1:] and not pattern:
        newest = set(recent([entry["key"] for entry in todo]))
        todo = [entry for entry in todo if entry["key"] in newest]
    print(f"{len(todo)} files are looked at, of {unknown} not known to be clean", flush=True)
    bad = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for entry, code, output in pool.map(lambda entry: tidy(entry, checks), todo):
            if code == 0 and "warning:" not in output:
                memory[entry["key"]] = entry["mark"]
                memory_file.write_text(json.dumps(memory, indent=1, sort_keys=True))  # now: who is stopped midway goes on from here
                continue
            bad += 1
            print(output.replace(f"{ROOT}/", ""), flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

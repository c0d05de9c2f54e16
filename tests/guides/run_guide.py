#!/usr/bin/env python3
"""Executes a guide of docs/guides exactly as it stands, in a scratch folder.

usage: run_guide.py PAGE --source FOLDER --build FOLDER

The scratch folder looks like a clone after a build: everything but out/ is a link, build/release the given build. All fenced `sh`
blocks of the page run in one shell, in their order. The test fails when a command fails, or when a file of out/ that the text
announces (`out/...` in backticks) is missing or empty afterwards, and before that when a link or picture of the page leads to a file
that is not in the tree. `--keep FOLDER` copies out/ there, to be looked at.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```([\w ]*)\n(.*?)^```$", re.M | re.S)
OUTPUT = re.compile(r"`(out/[^`\s]+)`")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def commands_of(page, rebuild):
    languages = ("sh", "sh rebuild") if rebuild else ("sh",)
    return "\n".join(text for language, text in FENCE.findall(page) if language in languages)


def outputs_of(page):
    return sorted(set(OUTPUT.findall(FENCE.sub("", page))))


def broken_links_of(page, folder):
    """Links to files, relative to the page's folder, that do not exist. Anchors within pages are not looked at."""
    files = [link.split("#")[0] for link in LINK.findall(FENCE.sub("", page)) if not re.match(r"[a-z]+:", link)]
    return sorted({file for file in files if file and not (folder / file).exists()})


def make_clone(scratch, source, build):
    for entry in source.iterdir():
        if entry.name not in ("out", "build", ".git"):
            (scratch / entry.name).symlink_to(entry)
    (scratch / "build").mkdir()
    (scratch / "build/release").symlink_to(build)


def copy_tree(scratch, source):
    """A clone that may be changed and is built anew; what was not committed comes along."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=source, check=True,
                            capture_output=True, text=True).stdout
    for name in filter(None, listed.split("\0")):
        if (source / name).is_file():
            (scratch / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source / name, scratch / name)
    subprocess.run(["cmake", "-S", ".", "--preset", "release"], cwd=scratch, check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--rebuild", action="store_true", help="in a copy of the tree, with the blocks `sh rebuild` as well")
    arguments = parser.parse_args()
    page = arguments.page.read_text()
    commands = commands_of(page, arguments.rebuild)
    if not commands:
        sys.exit(f"{arguments.page}: no `sh` block to execute")
    broken = broken_links_of(page, arguments.page.parent)
    if broken:
        sys.exit(f"{arguments.page}: links to files that do not exist: {', '.join(broken)}")
    with tempfile.TemporaryDirectory(prefix="cgsr-guide-") as folder:
        scratch = pathlib.Path(folder)
        if arguments.rebuild:
            copy_tree(scratch, arguments.source.resolve())
        else:
            make_clone(scratch, arguments.source.resolve(), arguments.build.resolve())
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=scratch, stdin=subprocess.DEVNULL,
                              env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
        if arguments.keep and (scratch / "out").exists():
            shutil.copytree(scratch / "out", arguments.keep, dirs_exist_ok=True)
        if done.returncode != 0:
            sys.exit(f"{arguments.page}: a command failed with exit code {done.returncode}")
        missing = [name for name in outputs_of(page)
                   if not (scratch / name).exists() or ((scratch / name).is_file() and (scratch / name).stat().st_size == 0)]
        if missing:
            sys.exit(f"{arguments.page}: announced, but missing or empty afterwards: {', '.join(missing)}")


if __name__ == "__main__":
    main()

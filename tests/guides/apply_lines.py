#!/usr/bin/env python3
"""Applies a patch to copies of the files that it changes.

usage: apply_lines.py SOURCE PATCH FOLDER

A copy is written only when its contents change, so that nothing is compiled for nothing. Fails when the patch does not apply.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def main():
    source, patch, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    files = re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(), re.M)
    with tempfile.TemporaryDirectory() as scratch:
        for name in files:
            target = pathlib.Path(scratch, name)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes((source / name).read_bytes())
        # Outside of any repository, where git applies a patch to files as they lie there.
        outside = {**os.environ, "GIT_CEILING_DIRECTORIES": str(pathlib.Path(scratch).parent)}
        # Who follows the guide has applied them already, and CMake runs once more.
        there = subprocess.run(["git", "apply", "--reverse", "--check", str(patch)], cwd=scratch, env=outside, capture_output=True)
        if there.returncode != 0:
            subprocess.run(["git", "apply", str(patch)], cwd=scratch, env=outside, check=True)
        for name in files:
            made, target = pathlib.Path(scratch, name).read_bytes(), folder / name
            if target.exists() and target.read_bytes() == made:
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(made)


if __name__ == "__main__":
    main()

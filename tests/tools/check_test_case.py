"""Runs a check of tools/ on a tree of one file."""
import pathlib
import subprocess
import sys
import tempfile
import unittest


class CheckTestCase(unittest.TestCase):
    check = ""  # its name in tools/

    def run_on(self, path, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            tool = pathlib.Path(__file__).resolve().parents[2] / "tools" / self.check
            return subprocess.run([sys.executable, tool, folder], capture_output=True, text=True)

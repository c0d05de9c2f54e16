#!/usr/bin/env python3
"""The completion that `cgsr completion bash` prints, as bash uses it.

usage: completion_test.py PROGRAM
"""
import subprocess
import sys
import unittest

PROGRAM = ""


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = subprocess.run([PROGRAM, "completion", "bash"], check=True, capture_output=True, text=True).stdout

    def complete(self, *words):
        """\\return what is offered for the last of the words."""
        listed = " ".join(f"'{word}'" for word in words)
        text = f"{self.script}\nCOMP_WORDS=({listed}); COMP_CWORD={len(words) - 1}; _cgsr; printf '%s\\n' \"${{COMPREPLY[@]}}\""
        return subprocess.run(["bash", "-c", text], check=True, capture_output=True, text=True).stdout.split()

    def test_offers_commands_and_those_below_them(self):
        self.assertEqual(self.complete("cgsr", "prof"), ["profile"])
        self.assertIn("camera", self.complete("cgsr", "devices", "c"))
        self.assertEqual(self.complete("cgsr", "config", "ke"), ["keys"])

    def test_offers_the_options_of_the_command_that_is_typed(self):
        self.assertEqual(self.complete("cgsr", "run", "--wait"), ["--wait-for-devices"])
        self.assertEqual(self.complete("cgsr", "run", "--config", "x.toml", "--dry"), ["--dry-run"])
        self.assertEqual(self.complete("cgsr", "devices", "base", "--te"), ["--test"])
        self.assertEqual(self.complete("cgsr", "check", "--wait"), [])
        self.assertIn("--webcam", self.complete("cgsr", "config", "new", "--w"))

    def test_offers_files_where_no_word_fits(self):
        self.assertIn("/etc", self.complete("cgsr", "run", "--config", "/et"))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()

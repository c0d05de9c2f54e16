"""Every row of docs/faults.md names a test, and every test that it names exists."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMED = re.compile(r"`(\w+)\.(\w+)`")
WRITTEN = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.M)


class Faults(unittest.TestCase):
    def test_every_row_has_a_test_that_exists(self):
        there = {name for file in (ROOT / "tests").rglob("*.cpp") for name in WRITTEN.findall(file.read_text())}
        rows = [line for line in (ROOT / "docs" / "faults.md").read_text().splitlines()
                if line.startswith("| ") and not line.startswith("| what |")]
        self.assertGreater(len(rows), 30)
        for row in rows:
            named = NAMED.findall(row)
            self.assertTrue(named, f"no test: {row}")
            for test in named:
                self.assertIn(test, there, row)


if __name__ == "__main__":
    unittest.main()

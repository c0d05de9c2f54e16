"""tools/test-parts.sh on made-up tests: what is flaky, what has failed, and what was left behind."""
import pathlib
import subprocess
import tempfile
import textwrap
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TESTS = {
    "good": "true",
    "flaky": "test -e once || { touch once; exit 1; }",
    "bad": "false",
    "temporary": 'touch "$TMPDIR/rest"',
    "cache": 'touch "$XDG_CACHE_HOME/image"',
    "source": "touch ../../new.txt",
}


class TestParts(unittest.TestCase):
    def run_tests(self, pattern):
        """The exit code and what is printed when the tests that match are run."""
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder) / "build" / "made-up"
            build.mkdir(parents=True)
            subprocess.run(["git", "init", "-q", folder], check=True)
            (pathlib.Path(folder) / ".git/info/exclude").write_text("/build/\n")
            (build / "CTestTestfile.cmake").write_text(
                "".join(f"add_test({name} sh -c [[{command}]])\n" for name, command in TESTS.items()))
            script = textwrap.dedent(f"""
                set -euo pipefail
                source {ROOT}/tools/common.sh
                root={folder}
                cd "$root"
                source {ROOT}/tools/test-parts.sh
                part "test made-up" run_tests made-up -R '^({pattern})$'
                report_parts""")
            run = subprocess.run(["bash", "-c", script], capture_output=True, text=True)
            return run.returncode, run.stdout + run.stderr

    def test_all_good(self):
        code, printed = self.run_tests("good")
        self.assertEqual(code, 0, printed)
        self.assertIn("all passed", printed)
        self.assertRegex(printed, r"test made-up +\d+\.\d min")
        self.assertNotIn("FLAKY", printed)

    def test_a_test_that_passes_when_run_once_more_is_named_as_flaky(self):
        code, printed = self.run_tests("good|flaky")
        self.assertEqual(code, 0, printed)
        self.assertRegex(printed, r"FLAKY[^\n]*\n  made-up: flaky\n")

    def test_failing_twice_is_a_failure(self):
        code, printed = self.run_tests("good|bad|flaky")
        self.assertEqual(code, 1, printed)
        self.assertIn("made-up tests (each twice): bad", printed)
        self.assertRegex(printed, r"FLAKY[^\n]*\n  made-up: flaky\n")

    def test_what_is_left_behind_is_a_failure(self):
        for name, left in {"temporary": "tmp/rest", "cache": "cache/image", "source": "?? new.txt"}.items():
            code, printed = self.run_tests(name)
            self.assertEqual(code, 1, printed)
            self.assertIn("left behind", printed)
            self.assertIn(left, printed)


if __name__ == "__main__":
    unittest.main()

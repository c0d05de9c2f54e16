"""tools/count on a made-up program and a made-up valgrind: what is run, in which order and with which images, and what is summed.

usage: count_test.py [CGSR]: with the program, also whether tools/count understands what `cgsr config show` prints of the shipped robots.
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Answers `config show` with its camera, and notes how else it was called.
PROGRAM = """\
    #!/bin/sh
    if [ "$1" = config ]; then echo '[camera]'; echo "kind = \\"$CAMERA\\"  # robot.toml:3"; echo '[base]'; echo 'kind = "sim"'; exit 0; fi
    echo "plain $CGSR_SIM_IMAGES: $*" >> "$NOTES"
    exit "${PLAIN_EXIT:-0}"
    """
# Notes the call, and writes two images of one stage: three and one million instructions.
VALGRIND = """\
    #!/bin/sh
    echo "counted $CGSR_SIM_IMAGES" >> "$NOTES"
    for word in "$@"; do case "$word" in --callgrind-out-file=*) out="${word#*=}" ;; esac; done
    printf 'desc: Trigger: Client Request: cgsr 0 track\\ntotals: 3000000\\n' > "$out"
    printf 'desc: Trigger: Client Request: cgsr 1 track\\ntotals: 1000000\\n' >> "$out"
    """
CGSR = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None


def counting():
    """tools/count as a module."""
    loader = importlib.machinery.SourceFileLoader("count", str(ROOT / "tools/count"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("count", loader))
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


class ShippedRobots(unittest.TestCase):
    @unittest.skipIf(CGSR is None, "skipped: no program named")
    def test_robots_with_a_simulated_camera_are_recognised(self):
        is_simulated_run = counting().is_simulated_run
        for robot, simulated in (("sim-home", True), ("sim-home-round", True), ("sim-home-lamp", True), ("video", False)):
            command = [CGSR, "run", "--config", str(ROOT / f"config/robots/{robot}.toml")]
            self.assertEqual(is_simulated_run(command), simulated, robot)


class Count(unittest.TestCase):
    def count(self, arguments, camera, plain_exit=0):
        """The finished run of tools/count, and the notes of what it ran."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, text in {"program": PROGRAM, "valgrind": VALGRIND}.items():
                (folder / name).write_text(textwrap.dedent(text))
                (folder / name).chmod(0o755)
            environment = {"PATH": f"{folder}:/usr/bin:/bin", "NOTES": str(folder / "notes"), "CAMERA": camera,
                           "PLAIN_EXIT": str(plain_exit)}
            run = subprocess.run([ROOT / "tools/count", "--json", folder / "json", "--", folder / "program", *arguments],
                                 env=environment, capture_output=True, text=True)
            notes = folder / "notes"
            result = json.loads((folder / "json").read_text()) if run.returncode == 0 else None
            return run, notes.read_text().splitlines() if notes.exists() else [], result

    def test_a_simulated_run_is_recorded_first_and_counted_on_its_recording(self):
        run, notes, result = self.count(["run", "--config", "robot.toml", "--duration", "1"], "sim")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(notes, ["plain record: run --config robot.toml --duration 1", "counted recorded"])
        self.assertAlmostEqual(result["stages"]["track"].pop("worst_second_minstr"), 4.0 / 30)
        self.assertEqual(result["stages"]["track"], {"mean_minstr": 2.0, "worst_minstr": 3.0, "images": 2})

    def test_other_commands_are_counted_at_once(self):
        for arguments, camera in ((["run", "--config", "robot.toml"], "replay"), (["track", "--config", "robot.toml"], "sim")):
            run, notes, _ = self.count(arguments, camera)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(notes, ["counted "])

    def test_nothing_is_counted_when_the_recording_fails(self):
        run, notes, _ = self.count(["run", "--config", "robot.toml"], "sim", plain_exit=3)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("ended with exit code 3 while its images were recorded", run.stderr)
        self.assertEqual(len(notes), 1)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""The service's unit: systemd accepts every line of it, its exposure is at most 2.5, and starts that fail pause longer each time."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
UNIT = ROOT / "config/service/cgsr.service"
PAUSE = ROOT / "config/service/restart-pause"


def run(*command, **more):
    return subprocess.run(command, capture_output=True, text=True, **more)


@unittest.skipUnless(shutil.which("systemd-analyze"), "SKIPPED: no systemd-analyze")
class Unit(unittest.TestCase):
    def test_systemd_knows_every_line(self):
        # The programs that it names are not installed here: harmless ones stand in for them.
        with tempfile.TemporaryDirectory() as folder:
            unit = pathlib.Path(folder) / "cgsr.service"
            text = re.sub(r"^(ExecStart(?:Pre)?)=.*$", r"\1=/bin/true", UNIT.read_text(), flags=re.M)
            unit.write_text(re.sub(r"^Documentation=.*\n", "", text, flags=re.M))
            outcome = run("systemd-analyze", "verify", "--man=no", str(unit))
            complaints = [line for line in outcome.stderr.splitlines() if "cgsr.service" in line]
            self.assertEqual(complaints, [])

    def test_exposure_is_at_most_2_5(self):
        outcome = run("systemd-analyze", "security", "--offline=true", "--threshold=25", "--no-pager", str(UNIT))
        level = re.search(r"Overall exposure level for cgsr.service: ([0-9.]+)", outcome.stdout)
        self.assertIsNotNone(level, outcome.stderr)
        self.assertLessEqual(float(level.group(1)), 2.5)
        self.assertEqual(outcome.returncode, 0)


class UnitText(unittest.TestCase):
    def test_checks_before_it_starts_waits_for_devices_and_has_no_capability(self):
        text = UNIT.read_text()
        for line in ("Type=notify", "User=cgsr", "CapabilityBoundingSet=\n", "Restart=on-failure", "LimitRTPRIO=80"):
            self.assertIn(line, text)
        self.assertRegex(text, r"ExecStartPre=\S+cgsr check --devices-may-be-late")
        self.assertRegex(text, r"ExecStart=\S+cgsr run --wait-for-devices")
        self.assertRegex(text, r"WatchdogSec=[0-9]")
        self.assertNotRegex(text, r"(?m)^(Requires|BindsTo)=")


class RestartPause(unittest.TestCase):
    def pauses(self, folder, starts):
        """How long each of so many starts in a row pauses, without pausing."""
        sleeper = pathlib.Path(folder) / "sleep"
        log = pathlib.Path(folder) / "slept"
        sleeper.write_text(f'#!/bin/sh\necho "$1" >>{log}\n')
        sleeper.chmod(0o755)
        slept = []
        for _ in range(starts):
            log.write_text("0\n")
            outcome = run(str(PAUSE), env={**os.environ, "RUNTIME_DIRECTORY": folder, "CGSR_SLEEP": str(sleeper)})
            self.assertEqual(outcome.returncode, 0, outcome.stderr)
            slept.append(int(log.read_text().split()[-1]))
            self.assertEqual("pausing" in outcome.stderr, slept[-1] > 0)
            # The pause was not slept: the start that it recorded lies in the future by as much.
            record = pathlib.Path(folder) / "starts"
            count, last = record.read_text().split()
            record.write_text(f"{count} {int(last) - slept[-1]}\n")
        return slept

    def test_doubles_up_to_half_a_minute(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.pauses(folder, 9), [0, 0, 1, 2, 4, 8, 16, 30, 30])

    def test_a_start_after_a_while_does_not_pause(self):
        with tempfile.TemporaryDirectory() as folder:
            self.pauses(folder, 5)
            record = pathlib.Path(folder) / "starts"
            count, last = record.read_text().split()
            record.write_text(f"{count} {int(last) - 11}\n")
            self.assertEqual(self.pauses(folder, 2), [0, 0])

    def test_a_damaged_record_and_a_clock_that_went_back_are_no_reason_to_pause_or_fail(self):
        with tempfile.TemporaryDirectory() as folder:
            for damaged in ("", "x y\n", "3\n", "7 99999999999\n"):
                (pathlib.Path(folder) / "starts").write_text(damaged)
                self.assertEqual(self.pauses(folder, 1), [0], damaged)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests of the judge: it must see what a robot does wrong."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import evaluate
import faults_table

JUDGE = pathlib.Path(__file__).with_name("evaluate.py")
DRIVES, STANDS, FOREIGN = "0064000000000000", "0000000000000000", "0007000000000000"


class Judge(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def judge(self, commands, marks, base=(), wall=lambda t: t):
        (self.path / "bus.log").write_text("".join(f"({1000 + t:.6f}) can0 413#{data}\n" for t, data in commands))
        (self.path / "marks.txt").write_text("".join(f"{1000 + wall(t):.6f} {t:.2f} {words}\n" for t, words in marks))
        if base:
            (self.path / "base.txt").write_text("".join(f"{t:.3f} 0 0 0 {v:.3f} 0\n" for t, v in base))
        run = subprocess.run([sys.executable, JUDGE, "faults", self.path], capture_output=True, text=True, check=False)
        return run.returncode == 0, json.loads((self.path / "result.json").read_text())["faults"]

    @staticmethod
    def steps(name, kind):
        steps = [(1.0, "injected"), (2.0, "ended"), (2.5, "back")]
        if kind in ("latches", "dies"):
            steps += [(4.0, "rearming"), (5.0, "rearmed")]
        return [(t, f"{name} {kind} {step}") for t, step in steps]

    @staticmethod
    def drive_until(last, again=4.5, foreign=()):
        commands = [(i / 100, DRIVES if i / 100 <= last or i / 100 > again else STANDS) for i in range(600)]
        return sorted(commands + [(t, FOREIGN) for t in foreign])

    def test_stopping_in_time_passes(self):
        passed, faults = self.judge(self.drive_until(1.12), self.steps("bus_down", "latches"))
        self.assertTrue(passed)
        self.assertAlmostEqual(faults[0]["last_motion_s"], 0.12, places=3)

    def test_stopping_late_fails(self):
        self.assertFalse(self.judge(self.drive_until(1.25), self.steps("bus_down", "latches"))[0])

    def test_motion_before_it_is_armed_again_fails(self):
        self.assertFalse(self.judge(self.drive_until(1.1, again=3.0), self.steps("bus_down", "latches"))[0])

    def test_one_that_holds_goes_on_by_itself_when_the_fault_ends(self):
        self.assertTrue(self.judge(self.drive_until(1.1, again=2.3), self.steps("camera_frozen", "holds"))[0])
        self.assertFalse(self.judge(self.drive_until(1.1, again=1.8), self.steps("camera_frozen", "holds"))[0], "before it ends")
        self.assertFalse(self.judge(self.drive_until(1.1, again=9.0), self.steps("camera_frozen", "holds"))[0], "never again")

    def by_stage(self, kind, again, rearming=()):
        """One that meets whatever stage runs: only the marks after its end say of which kind it was."""
        steps = [(1.0, "by_stage injected"), (2.0, "by_stage ended"), (2.5, f"{kind} back"), *((t, f"{kind} {step}") for t, step in rearming)]
        passed, faults = self.judge(self.drive_until(1.1, again=again), [(t, f"vision_starved {words}") for t, words in steps])
        self.assertEqual([fault["kind"] for fault in faults], [kind])
        return passed

    def test_one_that_meets_whatever_stage_runs_is_judged_by_what_it_met(self):
        arming = ((4.0, "rearming"), (5.0, "rearmed"))
        self.assertTrue(self.by_stage("holds", 2.3))
        self.assertFalse(self.by_stage("holds", 1.8), "moved before it ended")
        self.assertFalse(self.by_stage("holds", 9.0), "did not go on")
        self.assertTrue(self.by_stage("latches", 4.5, arming))
        self.assertFalse(self.by_stage("latches", 2.3, arming), "moved without being armed")
        self.assertFalse(self.by_stage("latches", 4.5), "was not armed again")

    def test_one_that_meets_whatever_stage_runs_and_breaks_off_fails(self):
        steps = [(1.0, "vision_starved by_stage injected")]
        self.assertFalse(self.judge(self.drive_until(1.1), steps)[0])
        self.assertFalse(self.judge(self.drive_until(1.1, again=9.0), [*steps, (2.0, "vision_starved by_stage ended"), (22.0, "vision_starved holds not-back")])[0])

    def test_one_that_goes_on_may_not_stop(self):
        self.assertTrue(self.judge(self.drive_until(9.0), self.steps("disk_full", "goes_on"))[0])
        self.assertFalse(self.judge(self.drive_until(1.1, again=1.3), self.steps("disk_full", "goes_on"))[0])
        self.assertFalse(self.judge(self.drive_until(1.1, again=9.0), self.steps("disk_full", "goes_on"))[0])

    def test_whether_it_stood_is_told_of_every_fault(self):
        self.assertTrue(self.judge(self.drive_until(1.12), self.steps("bus_down", "latches"))[1][0]["stood"])
        self.assertFalse(self.judge(self.drive_until(1.25), self.steps("bus_down", "latches"))[1][0]["stood"])
        passed, faults = self.judge(self.drive_until(9.0), self.steps("camera_queue", "goes_on"))
        self.assertTrue(passed)
        self.assertFalse(faults[0]["stood"], "it went on: met, and no stop")

    def test_a_dead_process_may_not_command(self):
        self.assertFalse(self.judge(self.drive_until(1.1), self.steps("killed", "dies"))[0])

    def test_commands_of_the_second_commander_do_not_count(self):
        self.assertTrue(self.judge(self.drive_until(1.1, foreign=(1.5, 1.7)), self.steps("second_commander", "latches"))[0])

    def test_a_base_that_does_not_stand_fails(self):
        steps, commands = self.steps("killed", "dies"), self.drive_until(1.0)
        moves = [(i / 100, 0.3) for i in range(600)]
        stops = [(i / 100, 0.3 if i / 100 < 1.45 else 0.0) for i in range(600)]
        self.assertFalse(self.judge(commands, steps, moves)[0])
        self.assertTrue(self.judge(commands, steps, stops)[0])

    def test_a_fault_that_did_not_come_back_fails(self):
        steps = [*self.steps("bus_down", "latches")[:2], (42.0, "bus_down latches not-back")]
        self.assertFalse(self.judge(self.drive_until(1.1, again=100.0), steps)[0])

    def test_a_robot_at_rest_shows_nothing(self):
        passed, faults = self.judge(self.drive_until(0.5), self.steps("bus_down", "latches"))
        self.assertFalse(passed)
        self.assertIn("not in motion", faults[0]["problem"])

    def test_a_wall_clock_that_is_set_changes_nothing(self):
        def wall(t):
            return t + (3600.0 if 1.0 <= t < 2.0 else 0.0)
        for last, right in ((1.12, True), (1.25, False)):
            commands = [(wall(t), data) for t, data in self.drive_until(last)]
            self.assertEqual(self.judge(commands, [(0.5, "ready"), *self.steps("clock_step", "latches")], wall=wall)[0], right)
        going_on = [(wall(t), data) for t, data in self.drive_until(9.0)]
        self.assertTrue(self.judge(going_on, [(0.5, "ready"), *self.steps("clock_step", "goes_on")], wall=wall)[0])

    def test_nothing_injected_fails(self):
        self.assertFalse(self.judge(self.drive_until(1.1), [(0.5, "ready")])[0])

    def test_an_image_that_was_written_over_before_it_was_read_is_missed(self):
        (self.path / "marks.txt").write_text("1010.0 10.00 play\n1012.0 12.00 end\n")
        for images, right in ((60, True), (57, False)):
            rows = "".join(f"{i},{10 + i / images * 2:.6f},1\n" for i in range(images))
            (self.path / "rows.csv").write_text("frame,stamp_s,found\n" + rows)
            report = evaluate.Report()
            evaluate.judge_rows("follow", self.path, None, report)
            self.assertEqual(report.passed, right)


class Table(unittest.TestCase):
    def test_parts_of_a_run_are_joined(self):
        fault = {"fault": "bus_down", "kind": "latches", "problem": "", "last_motion_s": 0.01, "allowed_s": 0.2, "back_s": 0.3, "stood": True, "met": True}
        page = faults_table.page([{"run": "faults", "faults": [fault]}, {"run": "faults", "faults": [fault, fault | {"last_motion_s": 0.15, "met": False}]}])
        self.assertIn("Injections: `tools/hil faults` 3.", page)
        self.assertIn("| 3 | 0.150 | 0.2 | 0.30 | - | 2 of 3 | 3 of 3 |", page)

    def test_what_was_judged_by_another_expectation_is_left_out(self):
        fault = {"fault": "bus_down", "kind": "holds", "problem": "", "last_motion_s": 0.01, "allowed_s": 0.2, "back_s": 0.3, "stood": True, "met": True}
        self.assertNotIn("the CAN interface goes down and up |", faults_table.page([{"run": "faults", "faults": [fault]}]))

    def test_one_that_meets_whatever_stage_runs_has_a_row_for_each_kind(self):
        fault = {"fault": "vision_starved", "kind": "holds", "problem": "", "last_motion_s": 0.13, "allowed_s": 0.2, "back_s": 0.9, "stood": True, "met": True}
        page = faults_table.page([{"run": "faults", "faults": [fault, fault | {"kind": "latches"}, fault | {"kind": "latches"}, fault | {"kind": "goes_on"}]}])
        self.assertIn("Injections: `tools/hil faults` 3.", page)
        self.assertIn("in no stage of the safety chain | stops, goes on by itself | 1 |", page)
        self.assertIn("in a stage of the safety chain | stops until armed again | 2 |", page)

    def test_every_fault_has_its_words(self):
        self.assertEqual(set(faults_table.expectations()), set(faults_table.WORDS))


if __name__ == "__main__":
    unittest.main()

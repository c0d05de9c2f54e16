#!/usr/bin/env python3
"""Judges a run of the virtual robot computer by what separate processes wrote down.

usage: evaluate.py NAME FOLDER --job-code N [--scene FOLDER | --cuts N --whole N]

Reads from FOLDER: bus.log (candump), marks.txt (the job), base.txt and feeder.json (the feeder), summary.json and rows.csv (the service). Writes
FOLDER/result.json, prints a table, exits with 0 when every requirement is met. A figure that could not be obtained is a failure.
"""
import argparse
import csv
import json
import pathlib
import re
import sys

ZERO_WITHIN_S = 0.2        # while the process lives: from the injection to the last command that is not zero
DRIVES_WITHIN_S = 0.05      # of a robot that goes on: the longest time between two commands that are not zero
SENT_BEFORE_DEATH_S = 0.02  # two control cycles: what was on its way when the process was killed
MOVING_BEFORE_S = 0.1       # a fault that meets a robot at rest shows nothing
BASE_WAITS_S = 0.4         # the simulated base goes on after the last command for this time
BASE_STANDS_S = 2.0        # and stands after this one
STANDS_MPS = 0.02
FOREIGN = (7, 0)           # what the second commander sends
MOTION_PERIOD_S = 0.01
IMAGE_RATE_HZ = 30
CLOCK_STEP_S = 60.0         # what a wall clock does not do by itself between two lines
TRACKED = {"round": ("corrected", "pose corrected"), "lamp": ("corrected", "pose corrected")}  # by its column; of the others, the object
WITHOUT_FAULTS = ("devices", "webcam")  # the job's exit code says it all
LINE = re.compile(r"^\((\d+\.\d+)\) \S+ (413|412)#([0-9A-F]*)")


def steady(times):
    """Takes the steps out of a wall clock that somebody sets: one of more than a minute, either way, counts as a control cycle."""
    shift, before, found = 0.0, None, []
    for time in times:
        if before is not None and abs(time - before) > CLOCK_STEP_S:
            shift += time - before - MOTION_PERIOD_S
        before = time
        found.append(time - shift)
    return found


def read_marks(folder):
    """(seconds since boot, words) of every mark, and the wall clock at boot. The kernel tells the time since boot in hundredths, rounded down:
    the smallest difference to the wall clock is the best, until somebody sets that one."""
    found = []
    for line in (folder / "marks.txt").read_text().splitlines():
        wall, boot, *words = line.split()
        found.append((float(wall), float(boot), words))
    if not found:
        return [], 0.0
    first = found[0][0] - found[0][1]
    zero = min(wall - boot for wall, boot, _ in found if abs(wall - boot - first) < CLOCK_STEP_S)
    return [(wall - zero if abs(wall - boot - zero) < CLOCK_STEP_S else boot, words) for wall, boot, words in found], zero


def marks(folder):
    return read_marks(folder)[0]


def commands(folder):
    """The commands of the bus log: (seconds since boot, velocity, turn), in counts."""
    times, values = [], []
    for line in (folder / "bus.log").read_text().splitlines():
        match = LINE.match(line)
        if not match or match[2] != "413" or len(match[3]) < 8:
            continue
        words = [int(match[3][k:k + 4], 16) for k in (0, 4)]
        times.append(float(match[1]))
        values.append(tuple(word - 0x10000 if word & 0x8000 else word for word in words))
    zero = read_marks(folder)[1]
    return [(time - zero, *value) for time, value in zip(steady(times), values)]


def base_states(folder):
    path = folder / "base.txt"
    if not path.exists():
        return []
    return [tuple(float(word) for word in line.split()) for line in path.read_text().splitlines()]


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else None


class Report:
    """Requirements with what was measured."""

    def __init__(self):
        self.rows = []

    def add(self, quantity, measured, required, met):
        self.rows.append({"quantity": quantity, "measured": measured, "required": required, "met": met})

    def print(self, name):
        width = max(len(row["quantity"]) for row in self.rows)
        print(f"\n{name}")
        for row in self.rows:
            verdict = {True: "met", False: "NOT MET", None: ""}[row["met"]]
            print(f"  {row['quantity']:<{width}}  {row['measured']!s:>24}  {row['required']:<34} {verdict}")

    @property
    def passed(self):
        return all(row["met"] is not False for row in self.rows)


# ---- faults

def cycles_of(all_marks):
    """The marks of each injected fault: (name, kind as the last mark has it, {step: seconds since boot})."""
    found = []
    for time, words in all_marks:
        if len(words) != 3:
            continue
        name, kind, step = words
        if step == "injected" or step in ("not-ready", "not-armed") or not found:
            found.append([name, kind, {}])
        found[-1][1] = kind  # of a fault that meets whatever stage runs, only the later marks say which it was
        found[-1][2][step] = time
    return [tuple(cycle) for cycle in found]


def judge_fault(name, kind, steps, sent, states):
    """What one injection came to, and whether it was as required. The kinds: tests/hil/guest/root/hil/faults."""
    if "injected" not in steps:
        return {"fault": name, "kind": kind, "problem": next(iter(steps), "nothing"), "met": False}
    begin = steps["injected"]
    own = [command for command in sent if command[1:] != FOREIGN]
    driving = any((v or w) and begin - MOVING_BEFORE_S <= t <= begin for t, v, w in own)
    result = {"fault": name, "kind": kind, "problem": next((step for step in steps if step.startswith("not-")), "")}
    if "ended" not in steps:
        result["met"] = False
        return result
    # The strictest expectation, whatever this fault's is: it stands beside the verdict.
    result["stood"] = not any((v or w) and begin + ZERO_WITHIN_S < t < steps["ended"] for t, v, w in own)
    if kind == "goes_on":
        met = judge_going_on(result, steps, own)
    else:
        met = judge_stop(result, kind, steps, own)
    back = next((t for t, v, w in own if t >= steps.get("rearming", steps["ended"]) and (v or w)), None)
    if back is not None and kind != "goes_on":
        result["back_s"] = round(back - steps.get("rearming", steps["ended"]), 2)
    if "rearming" in steps and "back" in steps:
        result["started_s"] = round(steps["back"] - steps["ended"], 2)
    if not driving:
        result["problem"] = "not in motion when it was injected"
    result["met"] = driving and met and not result["problem"] and back is not None
    if kind == "dies" and states:
        judge_base(result, steps, result["last_motion_s"], states)
    return result


def judge_stop(result, kind, steps, own):
    """The last command that is not zero, from the injection until the robot may drive again."""
    begin = steps["injected"]
    end = steps["ended"] if kind == "holds" else steps.get("rearming", float("inf"))
    moving = [t for t, v, w in own if begin <= t < end and (v or w)]
    result["last_motion_s"] = round(moving[-1] - begin if moving else 0.0, 4)
    result["allowed_s"] = SENT_BEFORE_DEATH_S if kind == "dies" else ZERO_WITHIN_S
    return result["last_motion_s"] <= result["allowed_s"] and (kind == "holds" or "rearmed" in steps)


def judge_going_on(result, steps, own):
    """The longest time without a command that is not zero while the fault lasts."""
    times = [t for t, v, w in own if steps["injected"] - MOVING_BEFORE_S <= t <= steps["ended"] and (v or w)]
    gaps = [b - a for a, b in zip(times, [*times[1:], steps["ended"]])]
    result["longest_gap_s"] = round(max(gaps, default=steps["ended"] - steps["injected"]), 4)
    result["allowed_s"] = DRIVES_WITHIN_S
    return result["longest_gap_s"] <= DRIVES_WITHIN_S


def judge_base(result, steps, after, states):
    """The base goes on for 0.4 s after the last command, then slows down and stands."""
    last = steps["injected"] + after
    speed = next((abs(state[4]) for state in states if state[0] >= last), 0.0)
    slows = next((state[0] - last for state in states if state[0] > last + 0.1 and abs(state[4]) < 0.8 * speed), None)
    stands = next((state[0] - last for state in states if state[0] > last and abs(state[4]) < STANDS_MPS), None)
    result |= {"base_speed_mps": round(speed, 3), "base_slows_s": slows and round(slows, 3), "base_stands_s": stands and round(stands, 3)}
    result["met"] = result["met"] and stands is not None and stands <= BASE_STANDS_S


def judge_faults(folder, report):
    sent, states = commands(folder), base_states(folder)
    results = [judge_fault(*cycle, sent, states) for cycle in cycles_of(marks(folder))]
    for name, kind in dict.fromkeys((result["fault"], result["kind"]) for result in results):
        own = [result for result in results if (result["fault"], result["kind"]) == (name, kind)]
        met = sum(result["met"] for result in own)
        key = "longest_gap_s" if kind == "goes_on" else "last_motion_s"
        worst = max((result.get(key, float("inf")) for result in own), default=None)
        what = "longest time without motion" if kind == "goes_on" else "last motion after it"
        allowed = next((result["allowed_s"] for result in own if "allowed_s" in result), ZERO_WITHIN_S)
        report.add(f"{name}, {kind}: {what}", f"{worst:.3f} s", f"at most {allowed} s, {met} of {len(own)}", met == len(own))
        for problem in dict.fromkeys(result["problem"] for result in own if result["problem"]):
            report.add(f"{name}, {kind}: problem", problem, "none", False)
    report.add("faults injected", len(results), "at least one", bool(results))
    return results


# ---- timing

def lateness(times):
    """How late each command is on the grid of its control cycles: the earliest one defines the grid."""
    if len(times) < 2:
        return []
    phases = []
    for time in times:
        cycle = round((time - times[0]) / MOTION_PERIOD_S)
        phases.append(time - times[0] - cycle * MOTION_PERIOD_S)
    earliest = percentile(phases, 0.01)
    return [phase - earliest for phase in phases]


def judge_timing(name, folder, scene, report):
    at = {words[0]: time for time, words in marks(folder)}
    begin, end = at["play"], at["end"]
    times = [t for t, _, _ in commands(folder) if begin <= t <= end]
    late = lateness(times)
    gaps = [b - a for a, b in zip(times, times[1:])]
    report.add("guest time played", f"{end - begin:.1f} s", "", None)
    report.add("control cycles on the bus", len(times), f"{(end - begin) / MOTION_PERIOD_S:.0f} ± 2", abs(len(times) - (end - begin) / MOTION_PERIOD_S) <= 2)
    worst = max(late, default=float("inf"))
    report.add("worst lateness of the motion thread", f"{worst * 1e3:.3f} ms", "at most 1 ms", worst <= 1e-3)
    report.add("p99 lateness of the motion thread", f"{(percentile(late, 0.99) or 0) * 1e3:.3f} ms", "", None)
    report.add("longest gap between two commands", f"{max(gaps, default=0) * 1e3:.2f} ms", "", None)
    judge_summary(folder, report)
    judge_rows(name, folder, scene, report)
    feeder = json.loads((folder / "feeder.json").read_text())
    for part in ("images", "base"):
        report.add(f"feeder, {part}: cost each", f"{feeder[part]['cpu_us_each']:.0f} us", "(taken from the robot's time)", None)
        report.add(f"feeder, {part}: worst lateness", f"{feeder[part]['worst_lateness_us']:.0f} us", "", None)


def judge_summary(folder, report):
    summary = json.loads((folder / "summary.json").read_text())
    frames = summary["frames"]
    report.add("images", summary["images"], "", None)
    report.add("images that took longer than a period (start included)", frames["late"], "0", frames["late"] == 0)
    report.add("frames without an image (start included)", frames["without_image"], "0", frames["without_image"] == 0)
    for name, stage in summary["stages"].items():
        report.add(f"stage {name}: mean, p99, worst, overruns",
                   f"{stage['mean_us']:.0f} {stage['p99_us']:.0f} {stage['worst_us']:.0f} us, {stage['overruns']}", f"budget {stage['budget_us']} us", None)


def judge_rows(name, folder, scene, report):
    rows = list(csv.DictReader((folder / "rows.csv").read_text().splitlines()))
    numbers = [int(row["frame"]) for row in rows]
    gaps = sum(b - a - 1 for a, b in zip(numbers, numbers[1:]))
    disorder = sum(b <= a for a, b in zip(numbers, numbers[1:]))
    report.add("images out of order", disorder, "0", disorder == 0)
    report.add("images lost", gaps, "0", gaps == 0)
    # v4l2loopback numbers no image, so that one that it wrote over shows only in the count.
    at = {words[0]: time for time, words in marks(folder)}
    played = sum(at["play"] <= float(row["stamp_s"]) < at["end"] for row in rows)
    wanted = (at["end"] - at["play"]) * IMAGE_RATE_HZ
    report.add("images while it played", played, f"{wanted:.0f} ± 2", abs(played - wanted) <= 2)
    column, what = TRACKED.get(name, ("found", "object found"))
    first = next((float(row["stamp_s"]) for row in rows if row[column] == "1"), None)
    report.add("boot to the first tracked image", f"{first:.1f} s" if first else "never", "at most 20 s", first is not None and first <= 20.0)
    report.add(what, f"{sum(row[column] == '1' for row in rows)} of {len(rows)} images", "", None)
    reference = scene and scene / "rows.csv"
    if reference and reference.exists():
        wanted = list(csv.DictReader(reference.read_text().splitlines()))
        share = sum(row[column] == "1" for row in wanted) / max(1, len(wanted))
        report.add(f"{what} in the lock-step run", f"{100 * share:.0f} % of its images", "", None)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--job-code", type=int, default=0)
    parser.add_argument("--scene", type=pathlib.Path)
    parser.add_argument("--cuts", type=int, help="how often the power went while a file was written")
    parser.add_argument("--whole", type=int, help="how often the file was one of its two contents at the next boot")
    options = parser.parse_args()
    report = Report()
    report.add("exit code of the job", options.job_code, "0", options.job_code == 0)
    result = {"run": options.name}
    try:
        if options.cuts is not None:
            report.add("file whole at the next boot", f"{options.whole} of {options.cuts}", "all", options.whole == options.cuts)
            result["power_cut"] = {"cuts": options.cuts, "whole": options.whole}
        elif (options.folder / "marks.txt").exists():
            if any(words[0] == "play" for _, words in marks(options.folder)):
                judge_timing(options.name, options.folder, options.scene, report)
            elif options.name not in WITHOUT_FAULTS:
                result["faults"] = judge_faults(options.folder, report)
        elif options.name not in WITHOUT_FAULTS:
            report.add("marks of the job", "none", "some", False)
    except (OSError, KeyError, ValueError) as problem:
        report.add("evaluation", f"{type(problem).__name__}: {problem}", "complete", False)
    result["requirements"] = report.rows
    result["passed"] = report.passed
    (options.folder / "result.json").write_text(json.dumps(result, indent=1) + "\n")
    report.print(options.name)
    return 0 if report.passed else 1


if __name__ == "__main__":
    sys.exit(main())

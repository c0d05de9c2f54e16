#!/usr/bin/env python3
"""The Debian package of the robot: what it holds, what lintian says, and that it installs, upgrades and purges in an empty root.

usage: package_test.py --source FOLDER --build FOLDER
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ARGUMENTS = argparse.Namespace()


def run(*command, check=True, **more):
    outcome = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if check and outcome.returncode != 0:
        raise AssertionError(f"{command}: {outcome.stdout}{outcome.stderr}")
    return outcome


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.scratch.name)
        run(ARGUMENTS.source / "tools/package-files", ARGUMENTS.build / "cgsr", ARGUMENTS.build / "package")
        run("cpack", "-G", "DEB", "-B", folder, "-D", "CPACK_COMPONENTS_ALL=cgsr", "--config", ARGUMENTS.build / "CPackConfig.cmake",
            cwd=ARGUMENTS.build)
        cls.deb = next(folder.glob("cgsr_*.deb"))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_holds_what_a_robot_needs_and_no_ray_tracer(self):
        files = {line.split()[5].lstrip(".") for line in run("dpkg-deb", "-c", self.deb).stdout.splitlines()}
        for wanted in ("/usr/bin/cgsr", "/usr/lib/cgsr/cgsr", "/usr/lib/systemd/system/cgsr.service", "/usr/lib/sysusers.d/cgsr.conf",
                       "/usr/lib/udev/rules.d/70-cgsr.rules", "/usr/lib/systemd/network/80-cgsr-can.network", "/etc/cgsr/robot.toml",
                       "/usr/share/cgsr/robots/segway-follow.toml", "/usr/share/cgsr/maps/home/map.obj",
                       "/usr/share/man/man1/cgsr.1.gz", "/usr/share/man/man1/cgsr-run.1.gz",
                       "/usr/share/bash-completion/completions/cgsr", "/usr/share/doc/cgsr/copyright"):
            self.assertIn(wanted, files)
        self.assertFalse([file for file in files if "simulation" in file or "scenarios" in file or "lab" in file.split("/")[-1:][0]])
        depends = run("dpkg-deb", "-f", self.deb, "Depends").stdout
        self.assertNotIn("embree", depends)
        self.assertIn("libc6", depends)

    def test_lintian_finds_no_error(self):
        if shutil.which("lintian") is None:
            self.skipTest("SKIPPED: no lintian")
        outcome = run("lintian", "--allow-root", "--fail-on", "error", self.deb, check=False)
        self.assertEqual([line for line in outcome.stdout.splitlines() if line.startswith("E:")], [])

    @unittest.skipUnless(os.geteuid() == 0, "SKIPPED: dpkg needs root")
    def test_installs_upgrades_keeps_the_administrators_file_and_purges(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for folder in ("var/lib/dpkg/info", "var/lib/dpkg/updates", "var/lib/dpkg/triggers", "etc"):
                (root / folder).mkdir(parents=True)
            for file in ("var/lib/dpkg/status", "var/lib/dpkg/available", "etc/passwd", "etc/group"):
                (root / file).touch()
            (root / "etc/group").write_text("video:x:44:\n")
            dpkg = ("dpkg", f"--root={root}", "--force-script-chrootless", "--force-depends", "--force-not-root", "--force-confdef",
                    "--force-confold")
            run(*dpkg, "-i", self.deb)
            self.assertTrue((root / "usr/bin/cgsr").is_symlink())
            self.assertTrue((root / "usr/bin/cgsr").resolve().name == "cgsr")
            self.assertIn("cgsr", (root / "etc/passwd").read_text())
            self.assertRegex((root / "etc/group").read_text(), "video:x:44:cgsr")
            robot = root / "etc/cgsr/robot.toml"
            robot.write_text("# mine\n")
            run(*dpkg, "-i", self.deb)  # the same as an upgrade: unpacked over what is there
            self.assertEqual(robot.read_text(), "# mine\n")
            run(*dpkg, "-r", "cgsr")
            self.assertTrue(robot.exists())
            self.assertFalse((root / "usr/bin/cgsr").exists())
            run(*dpkg, "--purge", "cgsr")
            left = [str(file.relative_to(root)) for file in root.rglob("*") if not file.is_dir() and "cgsr" in file.name]
            self.assertEqual(left, [])
            self.assertFalse(robot.parent.exists())


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])

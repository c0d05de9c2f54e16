"""tools/check_layers.py lets the project pass and catches each kind of wrong arrow."""
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECK = ROOT / "tools" / "check_layers.py"

spec = importlib.util.spec_from_file_location("check_layers", CHECK)
check_layers = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_layers)


def run(root):
    return subprocess.run([sys.executable, CHECK, root], capture_output=True, text=True)


class CheckLayers(unittest.TestCase):
    def tree(self, files):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for path, text in files.items():
            file = pathlib.Path(folder.name) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return folder.name

    def test_the_project_itself_passes(self):
        result = run(ROOT)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.returncode, 0)

    def assert_caught(self, files, words):
        result = run(self.tree(files))
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(words, result.stdout)

    def test_a_chapter_that_includes_a_device(self):
        self.assert_caught({"hal/camera.h": "", "pipeline/color/learn/a.cpp": '#include "hal/camera.h"\n'}, "pipeline/color/learn/a.cpp:1")

    def test_a_chapter_that_reads_a_clock(self):
        self.assert_caught({"platform/clock.h": "", "pipeline/color/learn/a.cpp": '\n#include "platform/clock.h"\n'}, "pipeline/color/learn/a.cpp:2")

    def test_a_chapter_with_a_thread(self):
        self.assert_caught({"pipeline/imaging/a.h": "#include <thread>\n"}, "knows no device, thread or clock")

    def test_platform_that_knows_the_pipeline(self):
        self.assert_caught({"pipeline/runtime/b.h": "", "platform/a.h": '#include "pipeline/runtime/b.h"\n'}, "platform may not include")

    def test_a_chapter_that_reads_a_configuration(self):
        self.assert_caught({"platform/config/reader.h": "", "pipeline/color/learn/a.h": '#include "platform/config/reader.h"\n'}, "pipeline/color/learn may not include")

    def test_a_loop_that_knows_the_simulation(self):
        self.assert_caught({"hal/simulation.h": "", "pipeline/vision_loop.h": '#include "hal/simulation.h"\n'}, "src only")

    def test_chapters_that_know_each_other(self):
        self.assert_caught({"pipeline/color/learn/b.h": "", "pipeline/localization/a.h": '#include "pipeline/color/learn/b.h"\n'}, "pipeline/localization may not include")

    def test_a_peer_outside_the_lab(self):
        self.assert_caught({"src/a.cpp": "#include <opencv2/tracking.hpp>\n"}, "tools/lab only")

    def test_truth_outside_tests_and_tools(self):
        self.assert_caught({"hal/sim/truth.h": "", "src/a.cpp": '#include "hal/sim/truth.h"\n'}, "hal/sim/truth.h may be included by tests")

    def test_a_path_that_does_not_start_at_the_root(self):
        self.assert_caught({"platform/a.h": '#include "b.h"\n', "platform/b.h": ""}, "not a path from the root")

    def test_a_sink_that_knows_the_boot(self):
        self.assert_caught({"src/boot/a.h": "", "src/sinks/b.h": '#include "src/boot/a.h"\n'}, "src/sinks may not include src/boot/a.h")

    def test_the_table_itself_has_no_circle(self):
        rows = {**check_layers.ALLOWED, **check_layers.PROGRAM}
        open_rooms = set(rows)
        while open_rooms:
            free = {room for room in open_rooms if not open_rooms & (set(rows[room]) - {room})}
            self.assertTrue(free, f"a circle among {sorted(open_rooms)}")
            open_rooms -= free

    def test_a_file_in_no_room(self):
        self.assert_caught({"extras/a.h": ""}, "no known room")

    def test_right_arrows_pass(self):
        result = run(self.tree({"platform/a.h": "", "hal/camera.h": '#include "platform/a.h"\n',
                                "pipeline/vision_loop.h": '#include "hal/camera.h"\n', "src/main.cpp": '#include "pipeline/vision_loop.h"\n'}))
        self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()

"""cmake/unity_groups.py: files of a target become one, their clashing names others, and what cannot be renamed stays apart."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HALF = "#include <cmath>\n\nnamespace {{\nstruct Options {{ double x = 0.0; }};\n}}  // namespace\n\ndouble {name}() {{ return {body}; }}\n"


class UnityGroups(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def groups(self, targets=("room",), **files):
        """Writes the files, has them grouped, and returns a list of their names for each group."""
        for name, text in files.items():
            (self.folder / f"{name}.cpp").write_text(text)
        listed = self.folder / "list.txt"
        listed.write_text("".join(f"{target}|/{target}s_folder|{self.folder}/{name}.cpp\n" for target in targets for name in files))
        return self.grouped(listed)

    def grouped(self, listed):
        out = subprocess.run([sys.executable, ROOT / "cmake/unity_groups.py", listed, self.folder / "unity"],
                             check=True, capture_output=True, text=True).stdout
        return [[Path(file).stem for file in line.split("|")[2:]] for line in out.splitlines()]

    def test_a_clashing_name_is_another_one_while_its_file_is_read(self):
        self.assertEqual(self.groups(a=HALF.format(name="a", body="Options{}.x"), b=HALF.format(name="b", body="Options{}.x")), [["a", "b"]])
        group = self.folder / "unity/room_0.cpp"
        subprocess.run(["g++", "-std=c++20", "-fsyntax-only", group], check=True)
        text = group.read_text()
        self.assertLess(text.index("#include <cmath>"), text.index("#define Options Options_in_b"))
        self.assertIn("#undef Options", text)

    def test_a_variable_shadows_no_name_of_another_file(self):
        self.assertEqual(self.groups(a=HALF.format(name="a", body="Options{}.x"), b="double b() { const double Options = 1.0; return Options; }\n"),
                         [["a", "b"]])
        subprocess.run(["g++", "-std=c++20", "-fsyntax-only", "-Wshadow", "-Werror", self.folder / "unity/room_0.cpp"], check=True)

    def test_a_name_that_means_something_else_too_stays(self):
        other = HALF.format(name="b", body="std::hypot(other::Options().x, 1.0)")
        self.assertEqual(self.groups(a=HALF.format(name="a", body="1.0"), b=other), [])

    def test_what_speaks_to_headers_stays_apart(self):
        for line in ("#define SIZE 3\n", 'extern "C" {\n#include <math.h>\n}\n', "#ifdef SIZE\n#endif\n"):
            self.assertEqual(self.groups(a=line, b="int b();\n", c="int c();\n"), [["b", "c"]], line)

    def test_targets_of_two_folders_group_the_same_files_each(self):
        self.assertEqual(self.groups(targets=("room", "guide"), a="int a();\n", b="int b();\n"), [["a", "b"], ["a", "b"]])

    def test_a_file_of_two_targets_of_a_folder_stays_apart(self):
        for name in "abc":
            (self.folder / f"{name}.cpp").write_text(f"int {name}();\n")
        listed = self.folder / "list.txt"
        listed.write_text("".join(f"{target}|/folder|{self.folder}/{name}.cpp\n" for target, name in ("xa", "xb", "xc", "yc")))
        self.assertEqual(self.grouped(listed), [["a", "b"]])


if __name__ == "__main__":
    unittest.main()

"""tools/check_enums.py names each public enum without a to_string(), and lets private ones and named exceptions pass."""
import unittest

from check_test_case import CheckTestCase


class CheckEnums(CheckTestCase):
    check = "check_enums.py"

    def reported(self, text, path="hal/rmp/a.h"):
        result = self.run_on(path, text)
        self.assertEqual(result.returncode, 1 if result.stdout else 0, result.stderr)
        return result.stdout

    def test_a_missing_to_string_is_reported_with_its_line(self):
        self.assertIn("hal/rmp/a.h:2: enum class Color: ", self.reported("\nenum class Color : int { kRed };\n"))
        self.assertIn("Color", self.reported("enum class Color { kRed };\nstd::string_view to_string(Shape shape);\n"))
        self.assertIn("Color", self.reported("enum class Color { kRed };\nstd::string to_string(Color color);\n"))

    def test_a_declared_one_passes(self):
        for declared in ("std::string_view to_string(Color color);", "constexpr std::string_view to_string(Color c) {"):
            self.assertEqual(self.reported(f"enum class Color {{ kRed }};\n{declared}\n"), "")

    def test_nested_ones_count_where_they_are_public(self):
        nested = "class Lamp {\n public:\n  enum class State { kOn };\n private:\n  enum class Step { kFirst };\n};\n"
        found = self.reported(nested)
        self.assertIn("a.h:3: enum class Lamp::State: ", found)
        self.assertNotIn("Step", found)
        self.assertEqual(self.reported(nested + "std::string_view to_string(Lamp::State state);\n"), "")
        self.assertIn("Lamp::Kind", self.reported("struct Lamp {\n  enum class Kind { kOne };\n};\n"))

    def test_sources_and_forward_declarations_pass(self):
        self.assertEqual(self.reported("enum class Color { kRed };\n", "hal/rmp/a.cpp"), "")
        self.assertEqual(self.reported("enum class Color : int;\nstruct A {};\n"), "")

    def test_exceptions_pass_and_may_not_outlive_their_enum(self):
        self.assertEqual(self.reported("enum class Overflow { kRefuse };\n", "platform/ring.h"), "")
        self.assertIn("no longer", self.reported("struct Ring {};\n", "platform/ring.h"))


if __name__ == "__main__":
    unittest.main()

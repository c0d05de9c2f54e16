"""tools/check_words.py names each listed word with its place, and lets the standard terms and the glossary pass."""
import unittest

from check_test_case import CheckTestCase


class CheckWords(CheckTestCase):
    check = "check_words.py"

    def test_each_word_is_reported_with_its_line(self):
        for word, term in [("FloorBelief", "planar pose estimate"), ("name_of(x)", "to_string()"), ("by_tip", "jacobian"),
                           ("where the robot is is not known", "robot pose unknown"), ("KnownSelf", "localization setup")]:
            result = self.run_on("src/a.cpp", f"\n{word}\n")
            self.assertEqual(result.returncode, 1, word)
            self.assertIn("src/a.cpp:2: ", result.stdout)
            self.assertIn(term, result.stdout)

    def test_file_names_any_case_and_scripts_without_suffix(self):
        self.assertIn("whereabouts.h: the file's name: 'whereabouts'", self.run_on("src/whereabouts.h", "\n").stdout)
        self.assertIn("tools/run:2: 'floorbelief'", self.run_on("tools/run", "#!/usr/bin/env bash\nfloorbelief\n").stdout)
        self.assertEqual(self.run_on("tools/data", "floorbelief\n").stdout, "")

    def test_standard_terms_and_the_glossary_pass(self):
        self.assertEqual(self.run_on("src/a.cpp", "to_string(rename_offset); // robot pose unknown\n").stdout, "")
        self.assertEqual(self.run_on("docs/glossary.md", "FloorBelief\n").returncode, 0)


if __name__ == "__main__":
    unittest.main()

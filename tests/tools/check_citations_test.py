"""tools/check_citations.py names each header without a citation, takes every form of one, and refuses numbers that do not exist."""
import unittest

from check_test_case import CheckTestCase

HEADER = "pipeline/color/a.h"


class CheckCitations(CheckTestCase):
    check = "check_citations.py"

    def test_every_form_of_a_citation_passes(self):
        for citation in ["Eq. 3.1", "(Alg. 4.1, line 3)", "Algorithm 5.2:", "Fig. 6.10", "Figure 5.1.", "Table 5.1", "(3.1.2)", "(5.2, line 3)",
                         "(the constraint, 3.1.2)", "section 6.4.1.1.", "(Canny 1986)", "(L1; Holland and Welsch 1977)",
                         "(merged, Bertinetto et al. 2016, doi 1)", "Ours; the dissertation uses OpenGL."]:
            result = self.run_on(HEADER, f"/// A filter. {citation}\nstruct A {{}};\n")
            self.assertEqual((result.returncode, result.stdout), (0, ""), citation)

    def test_a_citation_may_be_broken_across_two_lines(self):
        self.assertEqual(self.run_on(HEADER, "/// Edges (Besl and\n/// McKay 1992).\n").returncode, 0)

    def test_a_header_without_one_is_reported(self):
        for text in ["struct A {};\n", "/// Chapter 3's search, as in 2007.\n", "/// Moves (2 of 3.5 m), 4.1 m at most.\n", "/// Colours of hours.\n",
                     "f(3.2);  // the factor\n", 'say("Ours, Eq. 3.1");\n', "/// Sums (A 19861).\n"]:
            result = self.run_on(HEADER, text)
            self.assertEqual(result.returncode, 1, text)
            self.assertIn("pipeline/color/a.h:1: no citation", result.stdout)

    def test_what_the_dissertation_does_not_have_is_reported_with_its_line(self):
        for citation, named in [("(4.2.2)", "(4.2.2)"), ("Eq. 5.3", "Eq. 5.3"), ("Alg. 3.3", "Alg. 3.3"), ("section 5.1.1", "section 5.1.1")]:
            result = self.run_on(HEADER, f"/// Ours.\n/// See {citation}.\n")
            self.assertEqual(result.returncode, 1, citation)
            self.assertEqual(result.stdout, f"pipeline/color/a.h:2: the dissertation has no {named}\n")

    def test_other_rooms_and_sources_are_not_looked_at(self):
        for path in ["pipeline/color/a.cpp", "pipeline/runtime/a.h", "src/a.h"]:
            self.assertEqual(self.run_on(path, "struct A {};\n").returncode, 0, path)


if __name__ == "__main__":
    unittest.main()

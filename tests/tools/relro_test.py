#!/usr/bin/env python3
"""The loader accepts every program here: what it is to make read-only after relocation lies in pages that are loaded (cmake/options.cmake).

usage: relro_test.py PROGRAM...
"""
import os
import re
import subprocess
import sys
import unittest

PAGE = os.sysconf("SC_PAGE_SIZE")
PROGRAMS = sys.argv[1:]


def segments(kind, listing):
    """[(first address, size in memory), ...] of the segments of this kind in the output of `readelf -lW`."""
    rows = re.findall(rf"^ +{kind} +0x\w+ (0x\w+) 0x\w+ 0x\w+ (0x\w+)", listing, flags=re.M)
    return [(int(address, 16), int(size, 16)) for address, size in rows]


def not_loaded(listing):
    """The addresses of pages that are to be made read-only and are in no loaded segment; the loader rounds both ends down to pages."""
    floor = lambda address: address // PAGE * PAGE
    loaded = set()
    for first, size in segments("LOAD", listing):
        loaded.update(range(floor(first), first + size, PAGE))
    return [page for first, size in segments("GNU_RELRO", listing)
            for page in range(floor(first), floor(first + size), PAGE) if page not in loaded]


class Relro(unittest.TestCase):
    # As mold 1.10 linked it: thread-local variables end one page, and nothing is loaded into it.
    REFUSED = """
  LOAD           0x0ec3a0 0x00000000000ed3a0 0x00000000000ed3a0 0x38ec59 0x38e000 R E 0x1000
  LOAD           0x47b000 0x000000000047d000 0x000000000047d000 0x0052d1 0x006000 RW  0x1000
  GNU_RELRO      0x000000 0x000000000047cff9 0x000000000047cff9 0x0052d8 0x006007 R   0x1
"""

    def test_a_program_that_the_loader_refused_is_seen(self):
        self.assertEqual(not_loaded(self.REFUSED), [0x47c000])

    def test_every_program_can_be_loaded(self):
        self.assertTrue(PROGRAMS, "no programs were named")
        for program in PROGRAMS:
            listing = subprocess.run(["readelf", "-lW", program], capture_output=True, text=True, check=True).stdout
            self.assertTrue(segments("LOAD", listing), program)
            self.assertEqual([hex(page) for page in not_loaded(listing)], [], program)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/python3
"""Every C++ source is as clang-format leaves it."""

import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = sorted(f for kind in ("*.cpp", "*.hpp") for f in ROOT.glob(f"*/**/{kind}")
                 if f.relative_to(ROOT).parts[0] not in ("build", "out"))


class Format(unittest.TestCase):
    def test_sources_are_formatted(self):
        self.assertGreater(len(SOURCES), 300)
        run = subprocess.run(["clang-format", "--dry-run", *SOURCES], cwd=ROOT, capture_output=True, text=True, check=True)
        changed = sorted({line.partition(":")[0] for line in run.stderr.splitlines() if "[-Wclang-format" in line})
        self.assertEqual(changed, [], "run clang-format -i on these")


if __name__ == "__main__":
    unittest.main()

"""What the tests of the Python module share: a sonar and a place that take milliseconds, and the program beside them."""

import argparse
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))

from support import ProgramTest, read_grey  # noqa: E402,F401

import ensonify  # noqa: E402


class ModuleTest(ProgramTest):
    """A test in a temporary folder that holds small_sonar.yaml and block.yaml."""

    def sonar(self, **window):
        return ensonify.Sonar(self.folder / "small_sonar.yaml", **{"range_max_m": 8, "range_bins": 128, **window})

    def scene(self, layout=0):
        return ensonify.Scene(self.folder / "block.yaml", layout)

    def simulator(self, noise="paper", **options):
        return ensonify.Simulator(self.scene(), self.sonar(), noise, **options)

    def assertSameBits(self, a, b, message=None):
        a, b = numpy.asarray(a), numpy.asarray(b)
        self.assertEqual((a.dtype, a.shape), (b.dtype, b.shape), message)
        self.assertEqual(a.tobytes(), b.tobytes(), message)


POSE = ensonify.pose(-4, -4, -2, pitch_deg=10, yaw_deg=45)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    arguments, rest = parser.parse_known_args()
    ProgramTest.program = arguments.program.resolve()
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)

"""What the tests of the command line share: running the program, small sonars and recipes, reading datasets."""

import argparse
import hashlib
import json
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

import numpy

# Few beams and rays: the rules under test do not depend on their number.
SONAR = """name: small
title: small test sonar
frequency_hz: 1.2e6
bandwidth_hz: 100e3
source_level_db: 220
ping_rate_hz: 10
beams: {spacing: uniform_sine, count: 48, azimuth_fov_deg: 90}
range: {min_m: 0.2, max_m: 20, native_bin_m: 0.01}
pattern:
  azimuth_width_deg: 2
  azimuth_shading: hann
  elevation_fov_deg: 20
  elevation_shading: hann
receive:
  tvg_spreading_db: 40
  tvg_absorption_db_per_m: 0.5
  saturation_level_db: 180
  gamma: 0.5
rays: {azimuth_per_beam: 1, elevation: 48}
"""

# A sea of its own: one block on a flat bottom, built within milliseconds.
SCENE = """title: a block on a flat bottom
bounds: {min: [-6, -6, -4.4], max: [6, 6, 0]}
navigable: {min: [-5, -5, -3.4], max: [5, 5, -0.6]}
grid_resolution_m: 0.2
seabed: {shape: flat, depth_m: 4, thickness_m: 0.4, margin_m: 1, material: sand}
objects:
  - name: block
    shape: box
    length_m: {uniform: [1, 2]}
    width_m: 1
    height_m: 2
    pose: {x_m: {uniform: [-1, 1]}}
    on_seabed: true
    material: concrete
waypoints:
  - [-4, -4, -2, 0, 10, 45]
  - [4, -4, -2, 0, 10, 135]
"""

RECIPE = """name: small
seed: 5
sonar: {{model: small_sonar.yaml, range_max_m: {range_max_m}, range_bins: 128, gain_db: {{uniform: [-3, 3]}}}}
noise: paper
splits:
  train:
    frames: {train}
    places: [{{scene: block.yaml, layouts: [0, 1]}}]
    random_poses: {{pitch_deg: {{uniform: [0, 30]}}, least_seen_share: 0.05}}
  test:
    frames: {test}
    places: [{{scene: block.yaml, layouts: [2]}}]
    trajectory: {{speed_mps: 0.5, rate_hz: 2}}
"""


def changed(text, old, new):
    if old not in text:
        raise AssertionError(f"'{old}' is not there to be changed")
    return text.replace(old, new, 1)


class ProgramTest(unittest.TestCase):
    """A test in a temporary folder of its own, holding small_sonar.yaml and block.yaml."""

    program = pathlib.Path()

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("small_sonar.yaml", SONAR)
        self.write("block.yaml", SCENE)

    def write(self, name, text):
        path = self.folder / name
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text)
        return path

    def recipe(self, name="small.yaml", train=80, test=10, range_max_m="8"):
        return self.write(name, RECIPE.format(train=train, test=test, range_max_m=range_max_m))

    def environment(self):
        return {k: v for k, v in os.environ.items() if k != "ENSONIFY_DATA"}

    def run_program(self, *words):
        return subprocess.run([str(self.program), *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=120, env=self.environment())

    def start_program(self, *words):
        return subprocess.Popen([str(self.program), *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True, env=self.environment())

    def succeed(self, *words):
        done = self.run_program(*words)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}{done.stderr}")
        return done

    def refuse(self, code, fragments, *words):
        """The program ends with `code` and one error that holds every fragment; nothing crashes."""
        done = self.run_program(*words)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        for fragment in fragments:
            self.assertIn(fragment, done.stderr, words)
        return done

    def generate(self, out, *words, recipe="small.yaml"):
        self.succeed("generate", recipe, "--out", out, "--progress", "none", *words)
        return self.folder / out


def manifest(dataset):
    return json.loads((dataset / "dataset.json").read_text())


def files(folder, ignore=()):
    """Hash of every file below a folder, by relative path, hidden ones included."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file() and p.name not in ignore}


def leftovers(folder):
    return [p for p in folder.rglob("*") if ".tmp" in p.name]


def read_grey(path):
    """A greyscale PNG without filters, as the datasets have them."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits = struct.unpack(">IIB", chunk[:9])
        if kind == b"IDAT":
            packed += chunk
        at += 12 + size
    lines = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, -1)
    assert (lines[:, 0] == 0).all() and lines.shape[1] == 1 + width * bits // 8
    return numpy.ascontiguousarray(lines[:, 1:]).view(">u2" if bits == 16 else numpy.uint8)


def write_grey(path, image):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = b"".join(b"\0" + row.tobytes() for row in image)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *image.shape[::-1], 8, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    arguments, rest = parser.parse_known_args()
    ProgramTest.program = arguments.program.resolve()
    unittest.main(argv=["cli", *rest], verbosity=2)

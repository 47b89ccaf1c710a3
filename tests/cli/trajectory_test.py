#!/usr/bin/python3
"""Trajectories as a user meets them: every kind of path makes a set, which holds what the recipe says."""

import json
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from support import ProgramTest, files, main, manifest

RECIPE = """name: swum
seed: 4
sonar: {{model: small_sonar.yaml, range_max_m: 6, range_bins: 64}}
noise: paper
drift: {{radial_error_m: 1.1, after_s: 1200}}
splits:
  test:
    frames: {frames}
    places: [{{scene: block.yaml}}]
    trajectory: {{{trajectory}}}
"""
KINDS = {
    "scene": "path: waypoints, speed_mps: 0.4",
    "own": "waypoints: [[-4, -3, -1, 0, 5, 0], [4, -3, -2, 0, 5, 90], [4, 3, -1, 0, 5, 180]], rounding_m: 0.5",
    "lawnmower": "lawnmower: {depth_m: 1, spacing_m: 2, heading_deg: 30, pitch_deg: 20}, speed_mps: {uniform: [1, 2]}",
    "orbit": "orbit: {object: block, radius_m: 3, depth_m: 1.5}, clearance_m: 0.4",
    "wall": "wall: {object: block, standoff_m: 1, depth_m: 3}, attitude_noise: {roll_deg: 2, pitch_deg: 1, period_s: 4}",
}


class Trajectories(ProgramTest):
    def swum(self, name, trajectory, frames=5):
        self.write(f"{name}.yaml", RECIPE.format(frames=frames, trajectory=trajectory))

    def frames(self, name):
        return [json.loads(line) for line in (self.folder / name / "test/metadata.jsonl").read_text().splitlines()]

    def test_every_kind_makes_a_set_whose_frames_can_be_made_alone(self):
        for name, trajectory in KINDS.items():
            with self.subTest(name):
                self.swum(name, trajectory)
                whole = self.generate(name, recipe=f"{name}.yaml")
                self.succeed("verify", name)
                swum, = manifest(whole)["trajectories"]
                self.assertEqual((swum["place"], swum["duration_s"]), ("block", 2.0))
                self.assertGreater(swum["length_m"], 0.1)
                self.assertLess(swum["max_acceleration_mps2"], 8)
                lines = (whole / "test/metadata.jsonl").read_text().splitlines()
                alone = self.succeed("generate", f"{name}.yaml", "--out", f"{name}_alone", "--only", 3)
                self.assertEqual(alone.stdout.strip(), lines[3])
                self.assertEqual(files(whole)["test/raw/000003.png"],
                                 files(self.folder / f"{name}_alone")["test/raw/000003.png"])
        for frame in self.frames("orbit"):
            x, y, z = (row[3] for row in frame["T_world_sonar"][:3])
            first = self.frames("orbit")[0]["T_world_sonar"]
            centre_x = first[0][3] - 3  # it begins in the east
            self.assertAlmostEqual(math.hypot(x - centre_x, y), 3, 6)
            self.assertAlmostEqual(z, -1.5, 9)
        speeds = {frame["sampled"]["trajectory.speed_mps"] for frame in self.frames("lawnmower")}
        self.assertEqual(len(speeds), 1)
        self.assertTrue(1 <= speeds.pop() <= 2)
        self.assertEqual(manifest(self.folder / "wall")["recipe"]["splits"]["test"]["trajectory"]["wall"]["side"], "all")

    def test_a_trajectory_that_was_written_is_swum_again(self):
        self.swum("rocked", KINDS["wall"], 9)
        self.generate("rocked", recipe="rocked.yaml")
        self.swum("again", "file: rocked/test/trajectories/block.txt", 9)
        self.generate("again", recipe="again.yaml")
        for one, other in zip(self.frames("rocked"), self.frames("again"), strict=True):
            self.assertEqual(one["time"], other["time"])
            for row, again in zip(one["T_world_sonar"], other["T_world_sonar"]):
                for a, b in zip(row, again):
                    self.assertAlmostEqual(a, b, 8)
        self.swum("longer", "file: rocked/test/trajectories/block.txt", 10)
        self.refuse(2, ["longer.yaml:10", "covers 9 frames at 2 Hz", "asks for 10"], "generate", "longer.yaml", "--out",
                    "longer")
        self.assertFalse((self.folder / "longer/test").exists())

    def test_what_can_not_be_swum_is_refused_before_any_work(self):
        self.write("bad.txt", "0 0 0 -1 0 0 0 1\n1 0 0 -1 0 0 0 0\n")
        self.write("far.txt", "0 0 -4 -1 0 0 0 1\n500 0 -400 -1 0 0 0 1\n")
        for trajectory, code, fragments in (
                ("file: bad.txt", 1, ["bad.txt:2", "quaternion", "norm 0"]),
                ("file: none.txt", 1, ["none.txt"]),
                ("file: far.txt", 2, ["leaves the bounds", "give a file that keeps clear"]),
                ("orbit: {object: block, radius_m: 0.4, depth_m: 3}", 2, ["runs into something", "change radius_m"]),
                ("orbit: {object: blok, radius_m: 2, depth_m: 3}", 2, ["bad.yaml:10", "did you mean 'block'"]),
                ("orbit: {object: block, radius_m: 2}", 2, ["bad.yaml:10", "needs the key 'depth_m'"]),
                ("wall: {object: block, standoff_m: 1, depth_m: 1}", 2, ["nothing between", "it spans"]),
                ("lawnmower: {depth_m: 3, spacing_m: 0.5}", 2, ["runs into something", "change depth_m or area"]),
                ("lawnmower: {depth: 3, spacing_m: 0.5}", 2, ["bad.yaml:10", "did you mean 'depth_m'"]),
                ("path: lawnmower", 2, ["must be waypoints"])):
            with self.subTest(trajectory):
                self.swum("bad", trajectory, 600)
                self.refuse(code, fragments, "generate", "bad.yaml", "--out", "bad", "--force")
                self.assertFalse((self.folder / "bad/test").exists())


if __name__ == "__main__":
    main()

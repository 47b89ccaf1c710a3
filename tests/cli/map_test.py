#!/usr/bin/python3
"""ensonify map and evaluate map as a user meets them."""

import csv
import json
import math
import pathlib
import shutil
import tempfile

import numpy as np

from support import ProgramTest, leftovers, main

RECIPE = """name: mapped
seed: 5
sonar: {model: small_sonar.yaml, range_max_m: 8, range_bins: 128}
noise: paper
truth: true
splits:
  train:
    frames: 6
    places: [{scene: block.yaml, layouts: [0]}]
    random_poses: {pitch_deg: {uniform: [0, 30]}, least_seen_share: 0.05}
  test:
    frames: 16
    places: [{scene: block.yaml, layouts: [1, 2]}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
"""
PLACE = "block_layout1"


class MapTest(ProgramTest):
    made = None  # one set for all tests, each of which gets a copy of it

    def setUp(self):
        super().setUp()
        self.write("mapped.yaml", RECIPE)
        if MapTest.made is None:
            folder = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_maps_"))
            self.addClassCleanup(shutil.rmtree, folder)
            MapTest.made = self.generate(folder / "set", recipe="mapped.yaml")
        shutil.copytree(MapTest.made, self.folder / "set")

    def map(self, out, *words, scene=PLACE):
        return self.succeed("map", "set", "--scene", scene, "--out", out, "--progress", "none", *words)

    def load(self, name):
        with np.load(self.folder / name) as file:
            return {key: file[key] for key in file.files}

    def test_the_map_lies_in_the_cells_of_the_truth_grid(self):
        truth = self.load(f"set/grids/{PLACE}.npz")
        self.map("map.npz", "--filter", "clean", "--model", "carve")
        got = self.load("map.npz")
        self.assertEqual(got["log_odds"].shape, truth["occupancy"].shape)
        self.assertEqual(got["log_odds"].dtype, np.float32)
        self.assertEqual(got["origin"].tolist(), truth["origin"].tolist())
        self.assertEqual(got["resolution"], truth["resolution"])
        self.assertTrue((got["occupancy"] == (got["log_odds"] > 0)).all())
        self.assertTrue((got["observable"] == (got["log_odds"] != 0)).all())
        known = (got["observable"] == 1) & (truth["observable"] == 1)
        self.assertGreater(known.sum(), 1000)
        surfaces = got["log_odds"][known & (truth["occupancy"] == 1)] > 0
        self.assertGreater(surfaces.mean(), 0.9)
        self.assertGreater((got["log_odds"] < 0).sum(), 1000)

    def test_same_bits_with_any_number_of_threads(self):
        for model in ("points", "oracle"):
            self.map("one.npz", "--model", model, "--jobs", 1)
            self.map("two.npz", "--model", model, "--jobs", 2)
            self.assertEqual((self.folder / "one.npz").read_bytes(), (self.folder / "two.npz").read_bytes())
        for jobs in (1, 2):
            self.succeed("evaluate", "map", "set", "--out", f"scores{jobs}", "--jobs", jobs, "--filter", "raw", "--model",
                         "arc_shadow", "--max-frames", 3, "--threshold-max", 9, "--progress", "none")
        for name in ("map.csv", "summary.csv", "map.json"):
            self.assertEqual((self.folder / "scores1" / name).read_bytes(), (self.folder / "scores2" / name).read_bytes())

    def test_at_threshold_zero_all_that_is_marked_is_occupied(self):
        for model in ("points", "arc", "carve"):
            self.map("map.npz", "--model", model, "--threshold", 0)
            log_odds = self.load("map.npz")["log_odds"]
            self.assertGreaterEqual(log_odds.min(), 0)
            self.assertGreater(log_odds.max(), 0)

    def test_a_map_of_one_kind_of_cells_is_warned_of(self):
        for words, fragment in (((), "no free cell: equalisation after the filter"),
                                (("--no-post", "--threshold", 1), "no free cell: every pixel that was looked at"),
                                (("--threshold", 0), "no free cell: at --threshold 0"),
                                (("--threshold", 256), "no occupied cell: no pixel echoes; try a lower --threshold")):
            done = self.map("map.npz", "--model", "carve", *words)
            self.assertIn(f"ensonify: warning: the map has {fragment}", done.stderr, words)
        self.assertEqual(self.map("map.npz", "--model", "carve", "--filter", "clean").stderr, "")

    def test_every_format_is_written_and_nothing_else(self):
        for name in ("map.npz", "map.bt", "map.ot", "map.pgm", "map.ply"):
            self.map(f"maps/{name}", "--max-frames", 2)
        self.map("maps/map.pgm", "--slice-z", -2, "--max-frames", 2)
        names = sorted(p.name for p in (self.folder / "maps").iterdir())
        self.assertEqual(names, ["map.bt", "map.npz", "map.ot", "map.pgm", "map.ply", "map.yaml"])
        self.assertTrue((self.folder / "maps/map.ot").read_bytes().startswith(b"# Octomap OcTree file\n"))
        self.assertEqual(leftovers(self.folder / "maps"), [])

    def test_drifted_poses_give_another_map(self):
        self.map("true.npz", "--max-frames", 4)
        self.map("drifted.npz", "--max-frames", 4, "--poses", "drifted")
        self.assertFalse((self.load("true.npz")["log_odds"] == self.load("drifted.npz")["log_odds"]).all())

    def test_truth_mask_frees_more_than_the_raw_image(self):
        for name in ("none", "truth_mask"):
            self.map(f"{name}.npz", "--filter", name, "--model", "arc", "--threshold", 20)
        free = {name: (self.load(f"{name}.npz")["log_odds"] < 0).sum() for name in ("none", "truth_mask")}
        self.assertGreater(free["truth_mask"], free["none"])

    def test_random_poses_are_mapped_and_said_to_be_in_no_order(self):
        done = self.map("map.npz", "--split", "train", scene="block")
        self.assertIn("in no order", done.stdout)

    def test_without_a_truth_grid_the_box_is_what_the_pings_reach(self):
        (self.folder / f"set/grids/{PLACE}.npz").unlink()
        self.refuse(2, ["give --resolution"], "map", "set", "--scene", PLACE, "--out", "map.npz")
        self.map("map.npz", "--resolution", 0.25, "--max-frames", 3)
        got = self.load("map.npz")
        self.assertTrue(np.allclose(got["origin"] / 0.25, np.round(got["origin"] / 0.25)))
        known = np.argwhere(got["log_odds"] != 0)
        spare = np.array(got["log_odds"].shape) - (known.max(axis=0) - known.min(axis=0) + 1)
        self.assertTrue((spare >= 0).all())
        self.refuse(1, [f"grids/{PLACE}.npz is missing"], "evaluate", "map", "set", "--out", "scores")

    def test_another_resolution_keeps_the_box(self):
        self.map("map.npz", "--resolution", 0.4, "--max-frames", 2)
        truth, got = self.load(f"set/grids/{PLACE}.npz"), self.load("map.npz")
        high = lambda g, cells: g["origin"] + g["resolution"] * np.array(cells.shape[::-1])
        self.assertTrue((got["origin"] <= truth["origin"] + 1e-9).all())
        self.assertTrue((high(got, got["log_odds"]) >= high(truth, truth["occupancy"]) - 1e-9).all())
        self.assertLess(np.abs(high(got, got["log_odds"]) - high(truth, truth["occupancy"])).max(), 0.4)

    def test_wrong_arguments_are_refused_before_any_work(self):
        here = ["map", "set", "--scene", PLACE, "--out"]
        self.refuse(2, ["block_layout1, block_layout2", "--scene"], "map", "set", "--out", "map.npz")
        self.refuse(2, ["no place 'nowhere'", "block_layout1"], "map", "set", "--scene", "nowhere", "--out", "map.npz")
        self.refuse(2, ["no split 'val'", "train, test"], *here, "map.npz", "--split", "val")
        self.refuse(2, ["'.xyz'", ".npz, .bt, .ot, .pgm or .ply"], *here, "map.xyz")
        self.refuse(2, ["GiB", "--resolution"], *here, "map.npz", "--resolution", "0.00001")
        self.refuse(2, ["'beam' is unknown", "points, arc"], *here, "map.npz", "--model", "beam")
        self.refuse(2, ["lee_enhanced"], *here, "map.npz", "--filter", "lee_enhance")
        self.refuse(2, ["filter 'raw' is there twice"], "evaluate", "map", "set", "--out", "s", "--filter", "raw",
                    "--filter", "none")
        self.refuse(2, ["slice-z"], *here, "map.npz", "--slice-z", "-1")
        self.refuse(2, ["slice at z = 7"], *here, "map.pgm", "--slice-z", "7", "--max-frames", "1")
        self.refuse(1, ["no dataset.json"], "map", ".", "--out", "map.npz")
        self.assertEqual(list(self.folder.glob("map.*")), [])

    def edit_metadata(self, change):
        path = self.folder / "set/test/metadata.jsonl"
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        change(lines[3])
        path.write_text("".join(json.dumps(line) + "\n" for line in lines))

    def test_poses_that_are_missing_or_no_number_are_data_errors(self):
        def without(line):
            del line["T_world_sonar"]

        def not_a_number(line):
            line["T_world_sonar"][0][3] = math.nan

        def null(line):
            line["T_world_sonar_est"][1][3] = None

        for change, said in ((without, "has no T_world_sonar"), (not_a_number, ""), (null, "T_world_sonar_est must be finite")):
            original = (self.folder / "set/test/metadata.jsonl").read_text()
            self.edit_metadata(change)
            for words in (["map", "set", "--scene", PLACE, "--out", "map.npz"], ["evaluate", "map", "set", "--out", "s"]):
                self.refuse(1, ["metadata.jsonl", "line 4", said], *words)
            (self.folder / "set/test/metadata.jsonl").write_text(original)
        self.assertFalse((self.folder / "map.npz").exists())

    def test_the_oracle_needs_the_true_elevations(self):
        shutil.rmtree(self.folder / "set/test/truth")
        self.refuse(1, ["truth: true"], "map", "set", "--scene", PLACE, "--out", "map.npz", "--model", "oracle")
        self.refuse(1, ["truth: true"], "evaluate", "map", "set", "--out", "s", "--model", "oracle")
        self.succeed("evaluate", "map", "set", "--out", "scores", "--max-frames", 1, "--threshold-max", 1, "--filter",
                     "clean", "--progress", "none")
        with (self.folder / "scores/summary.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["model"] for row in rows}, {"points", "arc", "arc_shadow", "carve"})

    def test_the_table_is_what_its_raw_counts_say(self):
        self.succeed("evaluate", "map", "set", "--out", "scores", "--filter", "truth_mask", "--filter", "clean", "--model",
                     "points", "--model", "carve", "--poses", "both", "--tolerance", 2, "--threshold-max", 20,
                     "--progress", "none")
        with (self.folder / "scores/map.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 3 * 2 * 2 * 2 * 21)  # places and all, filters, models, poses, thresholds
        for row in rows:
            tp, fp, tn, fn = (int(row[key]) for key in ("tp", "fp", "tn", "fn"))
            for key, part, whole in (("fpr", fp, fp + tn), ("fnr", fn, fn + tp), ("fp_share", fp, tp + fp + tn + fn),
                                     ("coverage", tp + fp + tn + fn, int(row["observable"])),
                                     ("iou", tn, int(row["observable_occupied"]) + fn)):
                self.assertEqual(row[key] == "", whole == 0, key)
                if whole:
                    self.assertAlmostEqual(float(row[key]), part / whole, delta=1e-5)
            if row["threshold"] == "0":
                self.assertEqual((row["fpr"], row["fnr"]), ("0", "1"))
            self.assertGreaterEqual(float(row["f1_k2"] or 0), float(row["f1_k0"] or 0))
        whole = json.loads((self.folder / "scores/map.json").read_text())
        self.assertEqual(whole["positive"], "free")
        self.assertEqual(len(whole["curves"]), 3 * 2 * 2 * 2)
        drifted = [c for c in whole["curves"] if c["poses"] == "drifted"]
        self.assertTrue(all(c["summary"]["loss_f1_k2"] is not None for c in drifted))
        for name in ("curves_true.png", "curves_drifted.png", f"curves_{PLACE}_true.png", f"maps_{PLACE}.png"):
            self.assertTrue((self.folder / "scores" / name).read_bytes().startswith(b"\x89PNG"))

    def test_the_scores_are_those_of_the_map_that_map_writes(self):
        self.map("map.npz", "--filter", "clean", "--model", "arc", "--threshold", 12)
        self.succeed("evaluate", "map", "set", "--out", "scores", "--filter", "clean", "--model", "arc",
                     "--threshold-max", 12, "--progress", "none")
        truth, log_odds = self.load(f"set/grids/{PLACE}.npz"), self.load("map.npz")["log_odds"]
        scored, occupied = truth["observable"] == 1, truth["occupancy"] > 0
        with (self.folder / "scores/map.csv").open() as file:
            row = [r for r in csv.DictReader(file) if r["scene"] == PLACE and r["threshold"] == "12"][0]
        for key, cells in (("tp", (log_odds < 0) & ~occupied), ("fp", (log_odds < 0) & occupied),
                           ("tn", (log_odds > 0) & occupied), ("fn", (log_odds > 0) & ~occupied)):
            self.assertEqual(int(row[key]), (cells & scored).sum(), key)
        self.assertEqual(int(row["hidden_false_free"]), ((log_odds < 0) & occupied & ~scored).sum())
        p = 1 / (1 + np.exp(-log_odds.astype(float)))
        known = scored & (log_odds != 0)
        self.assertAlmostEqual(float(row["brier"]), ((p - occupied)[known] ** 2).mean(), delta=1e-5)


if __name__ == "__main__":
    main()

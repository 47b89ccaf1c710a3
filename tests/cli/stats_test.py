#!/usr/bin/python3
"""What `ensonify stats` says of a dataset, against the same figures by numpy from the files. See CONTRIBUTING.md."""

import json
import pathlib
import shutil
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from support import SONAR, ProgramTest, files, leftovers, main, manifest, read_grey, write_grey


class Frames:
    """Every image and line of metadata of some splits."""

    def __init__(self, dataset, splits):
        self.lines = []
        images = {kind: [] for kind in ("raw", "clean", "mask", "labels")}
        for split in splits:
            for line in map(json.loads, (dataset / split / "metadata.jsonl").read_text().splitlines()):
                self.lines.append(line)
                for kind in images:
                    name = line["file_name" if kind == "raw" else f"{kind}_file_name"]
                    images[kind].append(read_grey(dataset / split / name))
        self.raw, self.clean, self.mask, self.labels = (numpy.array(images[k]) for k in images)


class StatsTest(ProgramTest):
    def stats(self, dataset, *words):
        return json.loads(self.succeed("stats", dataset, "--json", "--progress", "none", *words).stdout)


class Figures(StatsTest):
    def check_summary(self, summary, values):
        self.assertEqual(summary["count"], len(values))
        for key, value in (("min", min(values)), ("mean", numpy.mean(values)), ("max", max(values))):
            self.assertAlmostEqual(summary[key], value, 9, key)
        histogram = summary["histogram"]
        expected, _ = numpy.histogram(values, len(histogram["counts"]), (histogram["low"], histogram["high"]))
        self.assertEqual(sum(histogram["counts"]), len(values))
        # A value on a border may be rounded to either side of it.
        self.assertLessEqual(numpy.abs(numpy.cumsum(histogram["counts"]) - numpy.cumsum(expected)).max(), 1)

    def check_figures(self, figures, frames, unit=1):
        self.assertEqual(figures["frames"], len(frames.lines))
        self.assertEqual(figures["frames_read"], len(frames.lines))
        set_pixels = frames.mask == 255
        shares = set_pixels.mean((1, 2))
        self.check_summary(figures["mask_share"], shares)
        for percent, value in figures["mask_share"]["percentiles"].items():
            self.assertAlmostEqual(value, numpy.percentile(shares, int(percent)), 9)
        self.assertEqual(list(figures["mask_share"]["percentiles"]), ["1", "5", "25", "50", "75", "95", "99"])
        self.assertAlmostEqual(figures["mask_share"]["below_0.005"], (shares < 0.005).mean(), 12)
        self.assertAlmostEqual(figures["mask_share"]["above_0.4"], (shares > 0.4).mean(), 12)
        self.assertAlmostEqual(figures["without_echo"], (~set_pixels.any((1, 2))).mean(), 12)
        for label, name in enumerate(("water", "direct", "multipath", "sidelobe", "shadow", "outside")):
            self.assertAlmostEqual(figures["label_share"][name], (frames.labels == label).mean(), 12)
        self.assertEqual(figures["raw_histogram"], numpy.bincount((frames.raw // unit).ravel(), minlength=256).tolist())
        self.assertEqual(figures["clean_histogram"], numpy.bincount(frames.clean.ravel(), minlength=256).tolist())
        poses = numpy.array([line["T_world_sonar"] for line in frames.lines])
        angles = {"roll_deg": numpy.arctan2(poses[:, 2, 1], poses[:, 2, 2]), "pitch_deg": numpy.arcsin(-poses[:, 2, 0]),
                  "yaw_deg": numpy.arctan2(poses[:, 1, 0], poses[:, 0, 0])}
        self.check_summary(figures["poses"]["depth_m"], -poses[:, 2, 3])
        for key, angle in angles.items():
            self.check_summary(figures["poses"][key], numpy.degrees(angle))
        keys = sorted({key for line in frames.lines for key in line["sampled"]})
        self.assertEqual(list(figures["sampled"]), keys)
        for key in keys:
            self.check_summary(figures["sampled"][key],
                               [line["sampled"][key] for line in frames.lines if key in line["sampled"]])

    def check_all(self, dataset, stats, unit=1):
        for split in ("train", "test"):
            self.check_figures(stats["splits"][split], Frames(dataset, [split]), unit)
        whole = Frames(dataset, ["train", "test"])
        self.check_figures(stats["overall"], whole, unit)
        for name, place in stats["places"].items():
            part = Frames(dataset, [])
            at = [i for i, line in enumerate(whole.lines) if line["place"] == name]
            part.lines = [whole.lines[i] for i in at]
            part.raw, part.clean, part.mask, part.labels = (a[at] for a in (whole.raw, whole.clean, whole.mask,
                                                                           whole.labels))
            self.check_figures(place, part, unit)
            self.assertEqual((place["scene"], place["layout"]), ("block", part.lines[0]["layout"]))
        return whole

    def test_they_are_those_of_numpy(self):
        self.recipe(train=24, test=6)
        dataset = self.generate("out")
        stats = self.stats("out")
        whole = self.check_all(dataset, stats)
        profile = stats["overall"]["range"]
        self.assertEqual((profile["range_min_m"], profile["range_max_m"]), (0.2, 8))
        numpy.testing.assert_allclose(profile["raw_level"], whole.raw.mean((0, 2)), rtol=1e-12)
        numpy.testing.assert_allclose(profile["mask_share"], (whole.mask == 255).mean((0, 2)), rtol=1e-12)
        self.assertEqual(stats["scenes"], {"block": 30})
        self.assertEqual(stats["never_seen"], [])
        self.assertEqual(stats["dataset"]["root_hash"], manifest(dataset)["root_hash"])

    def test_a_trajectory_has_the_length_and_drift_of_its_frames(self):
        self.recipe(train=2, test=8)
        lines = list(map(json.loads, (self.generate("out") / "test/metadata.jsonl").read_text().splitlines()))
        true, believed = (numpy.array([line[k] for line in lines])[:, :3, 3]
                          for k in ("T_world_sonar", "T_world_sonar_est"))
        way = self.stats("out")["places"]["block"]["trajectory"]
        self.assertAlmostEqual(way["length_m"], numpy.linalg.norm(numpy.diff(true, axis=0), axis=1).sum(), 9)
        self.assertAlmostEqual(way["drift_at_end_m"], numpy.linalg.norm(true[-1] - believed[-1]), 9)
        self.assertGreater(way["drift_at_end_m"], 0)
        self.assertEqual(way["duration_s"], 3.5)

    def test_sixteen_bits_and_a_window_of_its_own_for_each_frame(self):
        self.write("small_sonar.yaml", SONAR.replace("gamma: 0.5", "gamma: 0.5\n  bits: 16"))
        self.recipe(train=12, test=4, range_max_m="{uniform: [4, 8]}")
        dataset = self.generate("out")
        stats = self.stats("out")
        whole = self.check_all(dataset, stats, unit=256)
        bins = 256
        low, high = 0.2, max(line["range_max_m"] for line in whole.lines)
        pixels, level, mask = numpy.zeros(bins), numpy.zeros(bins), numpy.zeros(bins)
        for line, raw, set_pixels in zip(whole.lines, whole.raw, whole.mask):
            rows = len(raw)
            middle = low + (numpy.arange(rows) + 0.5) * (line["range_max_m"] - low) / rows
            at = ((middle - low) / (high - low) * bins).astype(int)
            numpy.add.at(pixels, at, raw.shape[1])
            numpy.add.at(level, at, raw.astype(float).sum(1) / 257)
            numpy.add.at(mask, at, (set_pixels == 255).sum(1))
        profile = stats["overall"]["range"]
        self.assertEqual([v is None for v in profile["raw_level"]], (pixels == 0).tolist())
        there = pixels > 0
        numpy.testing.assert_allclose(numpy.array(profile["raw_level"], float)[there], level[there] / pixels[there])
        numpy.testing.assert_allclose(numpy.array(profile["mask_share"], float)[there], mask[there] / pixels[there])

    def test_nearly_equal_training_frames_are_found_and_named(self):
        self.recipe(train=20, test=2)
        dataset = self.generate("out")
        self.assertEqual(self.stats("out")["variety"]["near_pairs"], 0)
        for kind in ("raw", "clean", "mask", "labels"):
            shutil.copy(dataset / f"train/{kind}/000004.png", dataset / f"train/{kind}/000011.png")
            write_grey(dataset / f"train/{kind}/000017.png", numpy.zeros((128, 48), numpy.uint8))
        variety = self.stats("out")["variety"]
        self.assertEqual((variety["frames"], variety["blank_frames"], variety["near_pairs"]), (20, 1, 1))
        self.assertEqual(variety["frames_in_near_pairs"], 2)
        pair, = variety["closest"]
        self.assertEqual((pair["a"], pair["b"]), ("train/clean/000004.png", "train/clean/000011.png"))
        self.assertEqual(pair["hash_distance"], 0)
        self.assertAlmostEqual(pair["correlation"], 1)
        self.assertGreater(pair["apart_m"], 0)
        self.assertEqual(self.stats("out")["splits"]["train"]["without_echo"], 1 / 20)

    def test_a_place_that_no_frame_shows_is_named(self):
        self.recipe(train=1, test=2)  # two places, one frame
        self.generate("out")
        stats = self.stats("out")
        self.assertEqual(stats["never_seen"], ["block_layout1"])
        self.assertEqual(stats["places"]["block_layout1"]["frames"], 0)
        self.assertIn("never seen: block_layout1", self.succeed("stats", "out").stdout)


class ByAnyRoad(StatsTest):
    def setUp(self):
        super().setUp()
        self.recipe(train=40, test=6)
        self.out = self.generate("out")

    def test_threads_format_and_folder_make_no_difference(self):
        self.succeed("stats", "out", "--jobs", 1, "--out", "one")
        self.succeed("stats", self.out, "--jobs", 2, "--out", "two")
        self.assertEqual(files(self.folder / "one"), files(self.folder / "two"))
        self.assertNotIn(str(self.folder), (self.folder / "one/stats.json").read_text())
        self.generate("web", "--format", "webdataset")
        folder, web = self.stats("out"), self.stats("web")
        self.assertEqual((folder["dataset"].pop("format"), web["dataset"].pop("format")), ("folder", "webdataset"))
        self.assertEqual(folder, web)
        self.succeed("stats", "web", "--out", "three")
        self.assertEqual(files(self.folder / "one", {"stats.json"}), files(self.folder / "three", {"stats.json"}))

    def test_it_leaves_the_dataset_whole(self):
        before = files(self.out)
        said = self.succeed("stats", "out").stdout
        self.assertIn("nearly equal pairs in train: 0", said)
        made = sorted(set(files(self.out)) - set(before))
        self.assertEqual(made, [f"stats/{n}" for n in ("contact_test.png", "contact_train.png", "stats.json", "stats.png")])
        self.assertEqual({p: h for p, h in files(self.out).items() if p in before}, before)
        self.succeed("verify", "out")
        self.generate("out")
        self.succeed("generate", "small.yaml", "--out", "out", "--seed", 9, "--force")
        self.succeed("verify", "out")
        self.assertEqual(leftovers(self.out), [])

    def test_few_frames_are_spread_over_every_place(self):
        stats = self.stats("out", "--max-frames", 9)
        read = {name: place["frames_read"] for name, place in stats["places"].items()}
        self.assertLessEqual(sum(read.values()), 9)
        self.assertGreaterEqual(sum(read.values()), 7)
        self.assertGreaterEqual(min(read.values()), 1)
        self.assertEqual(stats["overall"]["frames_read"], sum(read.values()))
        self.assertEqual(stats["overall"]["frames"], 46)
        self.assertEqual(stats["overall"]["poses"]["depth_m"]["count"], 46)
        self.assertEqual(sum(stats["overall"]["raw_histogram"]), 128 * 48 * sum(read.values()))
        self.assertEqual(self.stats("out", "--max-frames", 1000), self.stats("out"))
        self.refuse(2, ["--max-frames 2", "3 places"], "stats", "out", "--max-frames", 2)


class Refused(StatsTest):
    def setUp(self):
        super().setUp()
        self.recipe(train=8, test=2)
        self.out = self.generate("out")

    def check_found(self, name, change, fragments):
        copy = self.folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.out, copy)
        change(copy)
        with self.subTest(name):
            self.refuse(1, fragments, "stats", "copy", "--progress", "none")
            self.assertFalse((copy / "stats").exists(), "something was written all the same")

    def test_what_is_broken_is_named(self):
        def edit(path, old, new):
            return lambda copy: (copy / path).write_text((copy / path).read_text().replace(old, new, 1))

        def cut(path):
            return lambda copy: (copy / path).write_bytes((copy / path).read_bytes()[:-40])

        image = numpy.full((128, 48), 77, numpy.uint8)
        for case in (("cut image", cut("train/raw/000003.png"), ["train/raw/000003.png", "cut short"]),
                     ("missing image", lambda c: (c / "test/mask/000001.png").unlink(), ["test/mask/000001.png"]),
                     ("mask of greys", lambda c: write_grey(c / "train/mask/000002.png", image),
                      ["train 000002", "mask is not clean >= 8"]),
                     ("label beyond the legend", lambda c: write_grey(c / "train/labels/000002.png", image),
                      ["train 000002", "a label is 77"]),
                     ("another size", lambda c: write_grey(c / "train/labels/000002.png", image[:9]),
                      ["train 000002", "9 x 48 pixels, not 128 x 48"]),
                     ("bad JSON", edit("train/metadata.jsonl", '"place":', '"place"'), ["metadata.jsonl, line 1"]),
                     ("place of another split", edit("train/metadata.jsonl", '"place":"block_layout0"',
                                                     '"place":"block"'), ["line 1", "place block "]),
                     ("missing metadata", lambda c: (c / "train/metadata.jsonl").unlink(), ["train/metadata.jsonl"]),
                     ("broken manifest", cut("dataset.json"), ["dataset.json", "broken manifest"]),
                     ("no manifest", lambda c: (c / "dataset.json").unlink(), ["no dataset.json"])):
            self.check_found(*case)


if __name__ == "__main__":
    main()

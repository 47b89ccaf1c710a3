#!/usr/bin/python3
"""What `ensonify stats DIR --against FOLDER` says of both sides, against numpy; and what it refuses. See CONTRIBUTING.md."""

import json
import pathlib
import struct
import sys
import unittest
import zlib

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from support import ProgramTest, files, leftovers, main, read_grey, write_grey

BANDS = [{"id": "weibull_shape", "quantity": "shape", "min": 3.6, "max": 4.3},
         {"id": "acf_range_lag1", "quantity": "range", "min": None, "max": 0.25},
         {"id": "interping_corr_high_snr", "quantity": "pings", "min": 0.9, "max": None},
         {"id": "interping_corr_noise", "quantity": "noise", "target": 0, "min": None, "max": None},
         {"id": "zero_share", "quantity": "zeros", "min": None, "max": 0, "max_exclusive": True}]


def speckle(seed, rows=192, columns=96, level=60):
    """Root of Rayleigh's amplitude: Weibull of shape 4, every pixel by itself."""
    exponential = numpy.random.default_rng(seed).exponential(size=(rows, columns))
    return numpy.minimum(255, level * exponential ** 0.25).astype(numpy.uint8)


class AgainstTest(ProgramTest):
    def images(self, name, images):
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        for i, image in enumerate(images):
            write_grey(folder / f"ping_{i}.png", image)
        return folder

    def against(self, *words):
        return json.loads(self.succeed("stats", *words, "--json", "--progress", "none").stdout)


class Figures(AgainstTest):
    def check_levels(self, levels, images):
        stack = numpy.array(images)
        self.assertEqual(levels["pixels"], stack.size)
        self.assertAlmostEqual(levels["mean"], stack.mean(), 6)
        self.assertAlmostEqual(levels["std"], stack.std(), 6)
        self.assertAlmostEqual(levels["zero_share"], (stack == 0).mean(), 12)
        self.assertAlmostEqual(levels["saturated_share"], (stack >= 254).mean(), 12)
        self.assertEqual(levels["histogram"], numpy.bincount(stack.ravel(), minlength=256).tolist())
        for percent, value in levels["percentiles"].items():
            self.assertAlmostEqual(value, numpy.percentile(stack, float(percent)), 6, percent)
        for key, axes, parts in (("range_profile", (0, 2), 20), ("beam_profile", (0, 1), 16)):
            means = [part.mean() for part in numpy.array_split(stack.mean(axes), parts)]
            numpy.testing.assert_allclose(levels[key], means, rtol=1e-9)

    def test_the_quick_set_against_images_of_ours(self):
        self.succeed("generate", "quick", "--out", "quick", "--pairs", 2, "--progress", "none")
        still = [speckle(7)] * 3
        self.images("real", still)
        self.write("real/acceptance.json", json.dumps({"bands": BANDS}))
        self.write("real/notes.txt", "no image")
        before = files(self.folder / "quick")
        said = self.succeed("stats", "quick", "--against", "real", "--progress", "none").stdout
        for fragment in ("quick, split test (simulated) against real (real)", "20 of 20", "3 of 3", "weibull_shape",
                         "3.6 to 4.3", ">= 0.9", "inside", "OUTSIDE"):
            self.assertIn(fragment, said)
        made = sorted(set(files(self.folder / "quick")) - set(before))
        self.assertEqual(made, ["stats/against.json", "stats/against.png", "stats/against_pings.png"])
        self.assertEqual(leftovers(self.folder), [])
        self.succeed("verify", "quick")

        text = (self.folder / "quick/stats/against.json").read_text()
        self.assertNotIn(str(self.folder), text)
        found = json.loads(text)
        self.assertEqual((found["schema"], found["schema_version"]), ("ensonify-against", 1))
        simulated, real = found["simulated"], found["real"]
        self.assertEqual((simulated["name"], simulated["split"], simulated["images_read"]), ("quick", "test", 20))
        self.assertEqual((real["name"], real["split"], real["images_read"]), ("real", None, 3))
        self.assertEqual(real["first_image"], {"rows": 192, "columns": 96})
        raw = [read_grey(p) for p in sorted((self.folder / "quick/test/raw").glob("*.png"))]
        self.check_levels(simulated["levels"], raw)
        self.check_levels(real["levels"], still)
        # Two places of ten frames each, swum through: no pair across places, and none at rest.
        self.assertEqual((simulated["ping_to_ping"]["pairs"], simulated["ping_to_ping"]["still"]), (18, False))
        self.assertEqual((real["ping_to_ping"]["pairs"], real["ping_to_ping"]["still"]), (2, None))
        self.assertEqual(real["ping_to_ping"]["tiles"], 2 * 2 * 3)
        self.assertEqual(real["even_tiles"]["count"], 27)
        bands = {band["id"]: band for band in found["bands"]}
        self.assertEqual(list(bands), [band["id"] for band in BANDS])
        shape = bands["weibull_shape"]
        self.assertAlmostEqual(shape["real"], 4, delta=0.15)
        self.assertEqual((shape["min"], shape["max"], shape["real_inside"]), (3.6, 4.3, True))
        self.assertEqual(shape["real"], real["even_tiles"]["median"]["weibull"]["shape"])
        self.assertGreater(bands["interping_corr_high_snr"]["real"], 0.99)
        self.assertIsNone(bands["interping_corr_high_snr"]["simulated_inside"], "the sonar moved")
        self.assertIsNone(bands["interping_corr_noise"]["real_inside"], "no bound")
        self.assertEqual(bands["zero_share"]["real_inside"], False, "0 is not below 0")
        both = self.against("quick", "--against", "quick/val/raw", "--split", "val", "--max-frames", 5)
        self.assertEqual((both["simulated"]["images_read"], both["simulated"]["ping_to_ping"]["pairs"]), (4, 2))
        self.assertEqual(both["simulated"]["levels"], both["real"]["levels"])
        self.assertEqual(both["bands"], [])

    def test_tar_shards_say_the_same(self):
        self.recipe(train=2, test=6)
        self.generate("out")
        self.generate("web", "--format", "webdataset")
        self.images("real", [speckle(1)])
        folder, web = (self.against(name, "--against", "real")["simulated"] for name in ("out", "web"))
        self.assertEqual(folder, web)

    def test_a_region_is_measured_in_every_image(self):
        images = [speckle(seed) for seed in (1, 2, 3)]
        for image in images:
            image[32:96, 16:80] = speckle(9, 64, 64, 90)  # the same in all
        self.images("real", images)
        self.images("other", [numpy.repeat(speckle(5, 192, 48), 2, axis=1)])
        found = self.against("other", "--against", "real", "--region", "frozen=32 96 16 80", "--region", "100,192,0,96")
        frozen, rest = found["real"]["regions"]["frozen"], found["real"]["regions"]["100-192x0-96"]
        self.assertEqual((frozen["rows"], frozen["columns"]), ([32, 96], [16, 80]))
        self.assertGreater(frozen["ping_to_ping"], 0.99)
        self.assertLess(abs(rest["ping_to_ping"]), 0.05)
        self.assertAlmostEqual(frozen["mean_level"], images[0][32:96, 16:80].mean(), 5)
        self.assertAlmostEqual(rest["mean_level"], numpy.median([i[100:].mean() for i in images]), 5)
        self.assertAlmostEqual(rest["weibull"]["shape"], 4, delta=0.15)
        self.assertLess(abs(rest["acf_beam"][1]), 0.03)
        doubled = found["simulated"]["regions"]["100-192x0-96"]
        self.assertAlmostEqual(doubled["acf_beam"][1], 0.5, delta=0.03)  # every beam twice
        self.assertLess(abs(doubled["acf_range"][1]), 0.04)
        self.assertIsNone(doubled["ping_to_ping"])

    def test_flat_images_have_figures_too(self):
        for name, level in (("black", 0), ("grey", 100), ("white", 255)):
            self.images(name, [numpy.full((128, 64), level, numpy.uint8)] * 2)
            figures = self.against(name, "--against", name)["real"]
            self.assertEqual(figures["levels"]["percentiles"]["50"], level)
            self.assertEqual(figures["even_tiles"]["count"], 0 if level == 0 else 8)
            self.assertEqual(figures["levels"]["saturated_share"], level == 255)
            self.assertLess(abs(figures["ping_to_ping"]["brightest_quarter"]), 0.1, "jitter is no speckle")

    def test_threads_make_no_difference(self):
        self.images("real", [speckle(seed) for seed in range(5)])
        one, two = (self.against("real", "--against", "real", "--jobs", n) for n in (1, 2))
        self.assertEqual(one, two)


class Refused(AgainstTest):
    def setUp(self):
        super().setUp()
        self.images("good", [speckle(1)])

    def check(self, code, fragments, *words):
        with self.subTest(words):
            before = files(self.folder)
            self.refuse(code, fragments, "stats", *words, "--progress", "none")
            self.assertEqual(files(self.folder), before, "something was written all the same")

    def against_good(self, code, fragments, name, *words):
        self.check(code, fragments, name, "--against", "good", "--out", "out", *words)
        self.check(code, fragments, "good", "--against", name, "--out", "out", *words)

    def test_folders_that_hold_no_images(self):
        (self.folder / "empty").mkdir()
        self.against_good(1, ["lost", "no such folder"], "lost")
        self.against_good(1, ["empty", "no *.png"], "empty")
        self.against_good(1, ["good/ping_0.png", "no such folder"], "good/ping_0.png")

    def test_images_that_are_none(self):
        def colour(path):
            image = numpy.zeros((96, 64, 3), numpy.uint8)

            def chunk(kind, data):
                return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
            lines = b"".join(b"\0" + row.tobytes() for row in image)
            path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 64, 96, 8, 2, 0, 0, 0))
                             + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))

        def cut(path):
            write_grey(path, speckle(2))
            path.write_bytes(path.read_bytes()[:-30])

        for name, make, fragment in (("colour", colour, "must be a greyscale PNG"), ("cut", cut, "cut short"),
                                     ("text", lambda p: p.write_text("no image at all"), "no PNG file"),
                                     ("void", lambda p: p.write_bytes(b""), "no PNG file"),
                                     ("huge", lambda p: write_grey(p, numpy.zeros((4097, 4096), numpy.uint8)), "at most"),
                                     ("low", lambda p: write_grey(p, speckle(1, 63, 96)), "at least 64 rows"),
                                     ("narrow", lambda p: write_grey(p, speckle(1, 96, 31)), "32 columns")):
            make(self.images(name, [speckle(1)]) / "ping_1.PNG")
            self.against_good(1, [f"{name}/ping_1.PNG", fragment], name)

    def test_regions_that_are_none(self):
        for region, fragment in (("1 2 3", "fewer than four"), ("1 2 3 4 5", "more than four"), ("a b c d", "whole"),
                                 ("=0 64 0 64", "the name is empty"), ("9 3 0 64", "above the first"),
                                 ("-5 64 0 64", "none below 0"), ("0 64 0 97", "192 rows and 96 columns of good ping_0"),
                                 ("0 15 0 64", "16 of each"), ("0 99999999999 0 64", "whole")):
            self.check(2, [fragment], "good", "--against", "good", "--out", "out", "--region", region)
        self.check(2, ["two are called a"], "good", "--against", "good", "--out", "out", "--region", "a=0 64 0 64",
                   "--region", "a=0 64 0 32")

    def test_what_does_not_fit_together(self):
        self.check(2, ["--out"], "good", "--against", "good")
        self.check(2, ["--against"], "good", "--region", "0 64 0 64")
        self.check(2, ["--against"], "good", "--split", "test")
        self.check(2, ["--columns"], "good", "--against", "good", "--out", "out", "--columns", 3)
        self.check(1, ["no dataset.json"], "good")
        self.write("good/acceptance.json", json.dumps({"bands": [{"id": "beauty", "min": 1}]}))
        self.check(1, ["good/acceptance.json", "beauty", "weibull_shape"], "good", "--against", "good", "--out", "out")
        self.recipe(train=2, test=2)
        self.generate("set")
        self.check(2, ["no split val", "train, test"], "set", "--against", "good", "--split", "val")
        (self.folder / "set/dataset.json").unlink()
        self.check(1, ["unfinished"], "set", "--against", "good")


if __name__ == "__main__":
    main()

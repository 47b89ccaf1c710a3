#!/usr/bin/python3
"""`ensonify filter` and `ensonify evaluate filters` as a user meets them. See CONTRIBUTING.md."""

import csv
import json
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from support import RECIPE, SCENE, SONAR, ProgramTest, files, leftovers, main, read_grey, write_grey

try:
    from skimage.metrics import structural_similarity
except ImportError:
    structural_similarity = None


def speckled(rows=40, columns=50, seed=1):
    random = numpy.random.default_rng(seed)
    return numpy.clip(60 * random.rayleigh(0.8, (rows, columns)), 0, 255).astype(numpy.float32)


class Images(ProgramTest):
    def save(self, name, array):
        numpy.save(self.folder / name, array)
        return name

    def load(self, name):
        return numpy.load(self.folder / name)

    def test_the_list_names_every_method_of_the_design(self):
        listed = self.succeed("filter", "--list").stdout.split()
        for method in ("lee lee_enhanced kuan frost gamma_map srad anisodiff wavelet wiener median bilateral nlm cfar threshold "
                       "unet unet_clean pix2pix unsharp equalize mask").split():
            self.assertIn(method, listed)

    def test_an_array_keeps_its_fractions_and_an_image_is_rounded(self):
        image = speckled()
        self.save("in.npy", image)
        self.succeed("filter", "lee", "in.npy", "out.npy")
        out = self.load("out.npy")
        self.assertEqual((out.dtype, out.shape), (numpy.float32, image.shape))
        self.succeed("filter", "lee", "in.npy", "out.png")
        self.assertTrue((read_grey(self.folder / "out.png") == numpy.rint(out).astype(numpy.uint8)).all())

    def test_every_depth_is_the_same_scale(self):
        image = numpy.rint(speckled()).astype(numpy.uint8)
        write_grey(self.folder / "in8.png", image)
        self.save("in8.npy", image)
        self.save("in16.npy", image.astype(numpy.uint16) * 257)
        self.save("in_f8.npy", image.astype(numpy.float64))
        results = []
        for name in ("in8.png", "in8.npy", "in16.npy", "in_f8.npy"):
            self.succeed("filter", "kuan", name, "out.npy", "--set", "window=7")
            results.append(self.load("out.npy"))
        for result in results[1:]:
            self.assertLess(numpy.abs(result - results[0]).max(), 1e-4)

    def test_sixteen_bits_come_back_as_sixteen(self):
        self.save("in.npy", speckled().astype(numpy.float32))
        self.save("in16.npy", (speckled() * 257).astype(numpy.uint16))
        self.succeed("filter", "median", "in16.npy", "out.png")
        self.assertEqual(read_grey(self.folder / "out.png").dtype.itemsize, 2)

    def test_a_chain_is_its_steps(self):
        self.save("in.npy", speckled())
        self.write("chain.yaml", "name: mine\nsteps:\n  - {method: median, window: 3}\n  - {method: unsharp, amount: 0.5}\n")
        self.succeed("filter", "chain.yaml", "in.npy", "chain.npy")
        self.succeed("filter", "median", "in.npy", "median.npy", "--set", "window=3")
        self.succeed("filter", "unsharp", "median.npy", "steps.npy", "--set", "amount=0.5")
        self.assertTrue((self.load("chain.npy") == self.load("steps.npy")).all())

    def test_fans_are_filtered_as_bins_and_beams(self):
        self.write("small_sonar.yaml", SONAR)
        self.write("block.yaml", SCENE)
        self.succeed("ping", "block.yaml", "--sonar", "small_sonar.yaml", "--pose", "0 0 0 0 0 0", "--out", "ping")
        self.succeed("filter", "median", "ping/fan.png", "fan.npy", "--fan", "small_sonar.yaml")
        self.succeed("filter", "median", "ping/raw.png", "polar.npy")
        polar, fan = self.load("polar.npy"), self.load("fan.npy")
        self.assertEqual(fan.shape, read_grey(self.folder / "ping/fan.png").shape)
        bin_, _ = numpy.unravel_index(polar.argmax(), polar.shape)
        v, u = numpy.unravel_index(fan.argmax(), fan.shape)
        height, width = fan.shape
        reach_px = numpy.hypot(height - v - 0.5, width / 2 - u - 0.5)
        self.assertAlmostEqual(reach_px / height * polar.shape[0], bin_, delta=0.05 * polar.shape[0])
        self.succeed("filter", "cfar", "ping/fan.png", "mask.png", "--fan", "small_sonar.yaml")
        self.assertLessEqual(set(numpy.unique(read_grey(self.folder / "mask.png"))), {0, 255})
        self.refuse(1, ["pixels high", "raw.png"], "filter", "median", "ping/raw.png", "o.png", "--fan", "small_sonar.yaml")
        self.refuse(2, ["--range-max goes with --fan"], "filter", "median", "ping/raw.png", "o.png", "--range-max", "3")

    def test_presets(self):
        self.save("in.npy", speckled())
        self.succeed("filter", "wavelet", "in.npy", "default.npy")
        self.succeed("filter", "wavelet", "in.npy", "paper.npy", "--preset", "paper")
        self.succeed("filter", "wavelet", "in.npy", "tuned.npy", "--preset", "tuned")
        self.assertTrue((self.load("default.npy") == self.load("paper.npy")).all())
        self.assertFalse((self.load("default.npy") == self.load("tuned.npy")).all())

    def test_usage_errors(self):
        self.save("in.npy", speckled())
        for words, fragments in (
                (["wavlet", "in.npy", "o.npy"], ["no filter method 'wavlet'", "did you mean 'wavelet'?"]),
                (["lee", "in.npy", "o.npy", "--set", "windw=5"], ["did you mean 'window'?"]),
                (["lee", "in.npy", "o.npy", "--set", "window=5", "--set", "window=7"], ["--set window: is given twice"]),
                (["lee", "in.npy", "o.npy", "--set", "window=4"], ["odd number from 3 to 101, not '4'"]),
                (["lee", "in.npy", "o.npy", "--set", "window"], ["key=value"]),
                (["anisodiff", "in.npy", "o.npy", "--set", "kappa=-3"], ["kappa must be a number from"]),
                (["anisodiff", "in.npy", "o.npy", "--set", "gamma=nan"], ["gamma must be a number"]),
                (["lee", "in.npy", "o.tiff"], [".png, .exr or .npy"]),
                (["lee", "in.npy", "o.npy", "--preset", "tunned"], ["tuned"]),
                (["pix2pix", "in.npy", "o.npy"], ["model must be given", "docs/learned_filter.md"]),
                (["unet_clean", "in.npy", "o.npy", "--set", "domain=log"], ["unet_clean has no parameter 'domain'"]),
                (["pix2pix", "in.npy", "o.npy", "--set", "model=no.onnx"], ["no.onnx: no such file", "docs/learned_filter.md"]),
                (["lee", "in.npy"], ["METHOD, INPUT and OUTPUT"])):
            self.refuse(2, fragments, "filter", *words)
        self.assertFalse((self.folder / "o.npy").exists())

    def test_no_image_is_overwritten_by_what_becomes_of_it(self):
        write_grey(self.folder / "in.png", numpy.rint(speckled()).astype(numpy.uint8))
        (self.folder / "link.png").symlink_to("in.png")
        before = files(self.folder)
        for output in ("in.png", "./in.png", ".", "link.png"):
            self.refuse(2, ["would overwrite its own input"], "filter", "median", "in.png", output)
        self.assertEqual(files(self.folder), before)

    def test_broken_inputs(self):
        bad = speckled()
        bad[3, 7] = numpy.nan
        self.save("nan.npy", bad)
        self.save("cube.npy", numpy.zeros((3, 4, 5), numpy.float32))
        self.save("text.npy", numpy.array([["a"]]))
        self.write("cut.png", b"\x89PNG\r\n\x1a\n")
        self.write("cut.npy", (self.folder / "nan.npy").read_bytes()[:-4])
        for name, fragment in (("nan.npy", "row 3, column 7 is nan"), ("cube.npy", "two dimensions"), ("text.npy", "uint8"),
                               ("cut.png", "no PNG file"), ("cut.npy", "cut.npy"), ("absent.png", "no such file")):
            self.refuse(1, [name, fragment], "filter", "lee", name, "o.npy")
        self.write("wall", "a file, no folder")
        self.save("in.npy", speckled())
        self.refuse(1, ["wall"], "filter", "lee", "in.npy", "wall/o.npy")
        self.assertEqual(leftovers(self.folder), [])

    def test_a_folder_with_a_broken_file_keeps_the_others(self):
        (self.folder / "in").mkdir()
        for i in range(5):
            write_grey(self.folder / f"in/{i}.png", numpy.rint(speckled(seed=i)).astype(numpy.uint8))
        self.write("in/2.png", b"broken")
        self.write("in/notes.txt", "not an image")
        done = self.refuse(1, ["in/2.png", "no PNG file"], "filter", "frost", "in", "out", "--progress", "none")
        self.assertIn("4 of 5 images", done.stdout)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()), ["0.png", "1.png", "3.png", "4.png"])
        self.succeed("filter", "frost", "in/3.png", "alone.png")
        self.assertEqual((self.folder / "alone.png").read_bytes(), (self.folder / "out/3.png").read_bytes())
        (self.folder / "in/2.png").unlink()
        for jobs in ("1", "2"):
            self.succeed("filter", "frost", "in", f"out{jobs}", "--jobs", jobs, "--format", "npy", "--progress", "none")
        self.assertEqual(files(self.folder / "out1"), files(self.folder / "out2"))
        self.refuse(2, ["overwrite"], "filter", "frost", "in", "in")
        (self.folder / "empty").mkdir()
        self.refuse(1, ["no .png"], "filter", "frost", "empty", "out3")


class Evaluation(ProgramTest):
    def dataset(self):
        recipe = RECIPE.format(train=4, test=8, range_max_m="8")
        recipe += ("  val:\n    frames: 6\n    places: [{scene: block.yaml, layouts: [3]}]\n"
                   "    trajectory: {speed_mps: 0.5, rate_hz: 2}\n")
        self.write("set.yaml", recipe)
        return self.generate("set", recipe="set.yaml")

    def test_scores_are_those_of_the_images(self):
        dataset = self.dataset()
        self.succeed("evaluate", "filters", "set", "--out", "scores", "--progress", "none")
        self.succeed("evaluate", "filters", "set", "--out", "again", "--jobs", "1", "--progress", "none")
        for name in ("filters.csv", "filters.json", "filters.png", "frames.png"):
            self.assertEqual((self.folder / "scores" / name).read_bytes(), (self.folder / "again" / name).read_bytes(), name)
        self.assertTrue((self.folder / "scores/times.csv").is_file())
        lines = (self.folder / "scores/filters.csv").read_text().splitlines()
        rows = {(r["filter"], r["preset"], r["scene"]): r for r in csv.DictReader(lines)}
        report = json.loads((self.folder / "scores/filters.json").read_text())
        self.assertEqual((report["val_frames"], report["test_frames"]), (6, 8))
        self.assertEqual(len(report["rows"]), len(rows))

        raw, clean, mask = ([read_grey(p).astype(float) for p in sorted((dataset / "test" / kind).glob("*.png"))]
                            for kind in ("raw", "clean", "mask"))
        row = rows["raw", "", "all"]
        psnr = [10 * numpy.log10(255 ** 2 / ((a - b) ** 2).mean()) for a, b in zip(raw, clean)]
        self.assertAlmostEqual(float(row["psnr_db"]), numpy.mean(psnr), 3)
        if structural_similarity:
            ssim = [structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255)
                    for a, b in zip(raw, clean)]
            self.assertAlmostEqual(float(row["ssim"]), numpy.mean(ssim), 5)
        t = int(row["threshold"])
        gated = [10 * numpy.log10(255 ** 2 / ((numpy.where(a >= t, a, 0) - b) ** 2).mean()) for a, b in zip(raw, clean)]
        self.assertAlmostEqual(float(row["gated_psnr_db"]), numpy.mean(gated), 3)
        self.assertEqual(row["ghosts_removed"], "")  # open water
        pairs = [(a >= t, m > 0) for a, m in zip(raw, mask)]
        both = sum((a & m).sum() for a, m in pairs)
        self.assertAlmostEqual(float(row["iou"]), both / sum((a | m).sum() for a, m in pairs), 5)
        self.assertAlmostEqual(float(row["precision"]), both / sum(a.sum() for a, _ in pairs), 5)
        self.assertAlmostEqual(float(row["recall"]), both / sum(m.sum() for _, m in pairs), 5)
        self.assertLessEqual(float(row["iou_low"]), float(row["iou"]))
        self.assertGreaterEqual(float(row["iou_high"]), float(row["iou"]))
        truth = rows["truth_mask", "", "all"]
        self.assertEqual(float(truth["iou"]), 1.0)
        masked = [10 * numpy.log10(255 ** 2 / ((numpy.where(m > 0, a, 0) - b) ** 2).mean())
                  for a, b, m in zip(raw, clean, mask)]
        self.assertAlmostEqual(float(truth["masked_psnr_db"]), numpy.mean(masked), 3)


        val_raw, val_mask = ([read_grey(p).astype(float) for p in sorted((dataset / "val" / kind).glob("*.png"))]
                             for kind in ("raw", "mask"))

        def iou(level):
            pairs = [(a >= level, m > 0) for a, m in zip(val_raw, val_mask)]
            return sum((a & m).sum() for a, m in pairs) / sum((a | m).sum() for a, m in pairs)
        self.assertAlmostEqual(iou(t), max(map(iou, range(1, 256))), 9)

    def test_tuning_writes_a_preset_that_can_be_used(self):
        self.dataset()
        self.write("grid.yaml", "name: small\nmethods:\n  median: {window: [3, 5]}\n  lee: {cu: [0.25, 0.5], domain: [linear, log]}\n")
        self.succeed("evaluate", "filters", "set", "--tune", "--grid", "grid.yaml", "--out", "tuned", "--progress", "none")
        rows = list(csv.DictReader((self.folder / "tuned/tuning.csv").read_text().splitlines()))
        self.assertEqual(len(rows), 6)
        lee = [float(r["iou"]) for r in rows if r["filter"] == "lee"]
        self.assertEqual(lee, sorted(lee, reverse=True))
        image = next((self.folder / "set/test/raw").glob("*.png"))
        self.succeed("filter", "median", image, "o.png", "--preset", "tuned/tuned.yaml")
        self.write("bad.yaml", "name: bad\nmethods:\n  median: {window: [4]}\n")
        self.refuse(2, ["bad.yaml:3", "odd number"], "evaluate", "filters", "set", "--tune", "--grid", "bad.yaml", "--out", "o")

    def test_a_dataset_without_val_is_refused(self):
        self.recipe(train=4, test=4)
        self.generate("set")
        self.refuse(2, ["split 'val'"], "evaluate", "filters", "set", "--out", "scores", "--progress", "none")
        self.refuse(1, ["nowhere"], "evaluate", "filters", "nowhere", "--out", "scores")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""`python3 -m ensonify.training` as a user meets it: a tiny network learns, resumes to the same bits, and the program runs
what it wrote. Synthetic pairs and the small sonar of the command line's tests; one thread, seconds."""

import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "cli"))
from support import RECIPE, SCENE, SONAR, read_grey, write_grey

try:
    import torch
except ImportError:
    torch = None

arguments = None

# Enough for the easy task below: measured IoU .9 and more.
TINY = ("--ngf", "2", "--batch", "4", "--steps", "60", "--every", "20", "--lr", "0.01", "--threads", "1", "--seed", "3")
LEAST_IOU = 0.7


def write_pairs(folder, scenes=("pier", "quay"), count=4):
    """Bright ellipses under Rayleigh speckle: a threshold of any one level leaves holes and false echoes."""
    for half in ("raw", "mask"):
        (folder / half).mkdir(parents=True)
    random = numpy.random.default_rng(1)
    rows, columns = numpy.mgrid[:300, :280]
    for scene in scenes:
        for number in range(count):
            mask = numpy.zeros(rows.shape, bool)
            for _ in range(6):
                y, x, a, b = random.uniform((0, 0, 15, 15), (300, 280, 45, 45))
                mask |= ((rows - y) / a) ** 2 + ((columns - x) / b) ** 2 < 1
            raw = numpy.where(mask, 110, 30) * random.rayleigh(0.8, mask.shape)
            name = f"{scene}_{number:03}.png"
            write_grey(folder / "raw" / name, raw.clip(0, 255).astype(numpy.uint8))
            write_grey(folder / "mask" / name, mask.astype(numpy.uint8) * 255)


@unittest.skipIf(torch is None, "no torch here: apt install python3-torch libopenblas0-pthread")
class TrainingTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_training_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_training(self, *words):
        environment = {**os.environ, "PYTHONPATH": str(arguments.build / "python"), "OMP_WAIT_POLICY": "passive"}
        return subprocess.run(["/usr/bin/python3", "-m", "ensonify.training", *map(str, words)], cwd=self.folder,
                              env=environment, capture_output=True, text=True, timeout=500)

    def succeed(self, *words):
        done = self.run_training(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def refuse(self, code, fragments, *words):
        done = self.run_training(*words)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        for fragment in fragments:
            self.assertIn(fragment, done.stderr)

    def rows(self, out):
        with open(self.folder / out / "curves.csv", newline="") as file:
            return list(csv.DictReader(file))

    def checkpoint(self, out):
        return torch.load(self.folder / out / "checkpoint.pt", weights_only=True)

    def assert_same(self, a, b):
        self.assertIs(type(a), type(b))
        if isinstance(a, torch.Tensor):
            self.assertTrue(torch.equal(a, b))
        elif isinstance(a, dict):
            self.assertEqual(a.keys(), b.keys())
            for key in a:
                self.assert_same(a[key], b[key])
        elif isinstance(a, (list, tuple)):
            self.assertEqual(len(a), len(b))
            for x, y in zip(a, b):
                self.assert_same(x, y)
        else:
            self.assertEqual(a, b)

    def test_a_tiny_network_learns_and_the_program_runs_it(self):
        write_pairs(self.folder / "pairs")
        done = self.succeed("pairs", "--out", "model", "--val", "0.5", *TINY)
        self.assertIn("ETA", done.stderr)
        rows = self.rows("model")
        self.assertEqual([row["step"] for row in rows], ["20", "40", "60"])
        self.assertLess(float(rows[-1]["loss"]), 0.7 * float(rows[0]["loss"]))
        card = json.loads((self.folder / "model/model.json").read_text())
        self.assertEqual(set(card), {"schema", "network", "heads", "ngf", "parameters", "sha256", "input_range", "threshold", "license",
                                     "metrics", "training"})
        self.assertEqual((card["network"], card["ngf"], card["input_range"]), ("unet", 2, [0, 1]))
        self.assertGreater(card["metrics"]["iou"], LEAST_IOU)
        self.assertEqual(list(card["metrics"]["iou_by_scene"]), ["quay"])
        self.assertLessEqual({"data", "root_hash", "pairs", "seed", "steps", "best_step", "torch"}, set(card["training"]))
        self.assertEqual((self.folder / "model/curves.png").read_bytes()[:4], b"\x89PNG")

        subprocess.run([arguments.program, "filter", "unet", "pairs/raw", "masks", "--set", "model=model/model.onnx",
                        "--progress", "none"], cwd=self.folder, check=True, capture_output=True)
        both = either = 0
        for path in sorted((self.folder / "masks").glob("quay_*.png")):
            mask, truth = read_grey(path), read_grey(self.folder / "pairs/mask" / path.name)
            self.assertLessEqual(set(numpy.unique(mask)), {0, 255})
            both += ((mask > 0) & (truth > 0)).sum()
            either += ((mask > 0) | (truth > 0)).sum()
        self.assertAlmostEqual(both / either, card["metrics"]["iou"], 3)

    def test_a_stopped_training_ends_in_the_same_bits(self):
        write_pairs(self.folder / "pairs")
        # Dropout and a discriminator: all that could go another way.
        words = ("pairs", "--model", "pix2pix", "--val", "0.5", "--ngf", "1", "--every", "2", "--crops", "3", "--threads", "1")
        self.succeed(*words, "--steps", "6", "--out", "whole")
        stopped = self.folder / "stopped"
        # The state after step 2, as an interruption leaves it.
        script = ("import sys; from ensonify.training import loop, options\n"
                  "save = loop.save_checkpoint\n"
                  "def stop(path, state):\n    save(path, state)\n    raise KeyboardInterrupt\n"
                  "loop.save_checkpoint = stop\nloop.train(options.parse_options(sys.argv[1:]))\n")
        environment = {**os.environ, "PYTHONPATH": str(arguments.build / "python")}
        subprocess.run(["/usr/bin/python3", "-c", script, *words, "--steps", "6", "--out", "stopped"], cwd=self.folder,
                       env=environment, capture_output=True)
        self.assertEqual(self.checkpoint("stopped")["step"], 2)
        self.succeed(*words, "--steps", "6", "--out", "stopped", "--resume", "--workers", "3")
        self.assert_same(self.checkpoint("whole"), self.checkpoint("stopped"))
        for name in ("model.onnx", "model.json", "curves.csv"):
            self.assertEqual((stopped / name).read_bytes(), (self.folder / "whole" / name).read_bytes(), name)
        self.refuse(2, ["a training is already there", "--resume"], *words, "--steps", "6", "--out", "stopped")
        self.refuse(2, ["--seed 0, not 1"], *words, "--steps", "6", "--out", "stopped", "--resume", "--seed", "1")

    def test_datasets_and_recipes_train_too(self):
        (self.folder / "small_sonar.yaml").write_text(SONAR)
        (self.folder / "block.yaml").write_text(SCENE)
        recipe = RECIPE.format(train=12, test=4, range_max_m="8")
        recipe += ("  val:\n    frames: 4\n    places: [{scene: block.yaml, layouts: [3]}]\n"
                   "    trajectory: {speed_mps: 0.5, rate_hz: 2}\n")
        (self.folder / "small.yaml").write_text(recipe)
        subprocess.run([arguments.program, "generate", "small.yaml", "--out", "set", "--progress", "none"], cwd=self.folder,
                       check=True, capture_output=True)
        tiny = ("--ngf", "1", "--batch", "2", "--every", "2", "--threads", "1")
        self.succeed("set", "--out", "of_set", "--epochs", "1", "--crops", "1", *tiny)
        card = json.loads((self.folder / "of_set/model.json").read_text())
        manifest = json.loads((self.folder / "set/dataset.json").read_text())
        self.assertEqual(card["training"]["root_hash"], manifest["root_hash"])
        self.assertEqual((card["training"]["pairs"], card["training"]["steps"]), (12, 6))
        self.succeed("small.yaml", "--out", "of_recipe", "--steps", "2", "--from", "of_set/checkpoint.pt", *tiny)
        self.assertIn("recipe small", json.loads((self.folder / "of_recipe/model.json").read_text())["training"]["data"])
        self.succeed("set", "--out", "of_clean", "--steps", "2", "--clean", *tiny)
        card = json.loads((self.folder / "of_clean/model.json").read_text())
        self.assertEqual(card["heads"], ["echo", "clean"])
        self.assertGreater(card["metrics"]["clean_psnr_db"], 0)
        self.assertIn("clean_psnr_db", self.rows("of_clean")[0])
        self.succeed("set", "--out", "of_other", "--steps", "2", "--val", "set", *tiny)
        self.assertEqual(json.loads((self.folder / "of_other/model.json").read_text())["training"]["val"], "set")
        self.refuse(2, ["split 'nowhere'"], "set", "--out", "x", "--val", "nowhere", *tiny)
        self.refuse(2, ["clean=True", "clean=False"], "set", "--out", "x", "--from", "of_clean/checkpoint.pt", *tiny)
        self.refuse(2, ["--clean goes with --model unet"], "set", "--out", "x", "--clean", "--model", "pix2pix")
        self.refuse(2, ["ngf=1", "ngf=2"], "set", "--out", "x", "--from", "of_set/checkpoint.pt", "--ngf", "2")

    def test_the_program_runs_an_untrained_network(self):
        """Its biases are all alike, which torch would write once and refer to."""
        write_pairs(self.folder / "pairs", count=1)
        script = ("import pathlib; from ensonify.training import export, networks\n"
                  "for name in networks.NAMES:\n"
                  "    kind = networks.NetworkKind(name, 1)\n"
                  "    pathlib.Path(name).mkdir()\n"
                  "    export.write_model(pathlib.Path(name), networks.make_network(kind), kind, threshold=0.5, license='none',\n"
                  "                       metrics={}, training={})\n")
        environment = {**os.environ, "PYTHONPATH": str(arguments.build / "python")}
        subprocess.run(["/usr/bin/python3", "-c", script], cwd=self.folder, env=environment, check=True)
        for name in ("unet", "pix2pix"):
            subprocess.run([arguments.program, "filter", name, "pairs/raw/pier_000.png", "mask.png",
                            "--set", f"model={name}/model.onnx"], cwd=self.folder, check=True, capture_output=True)

    def test_what_is_wrong_is_named(self):
        write_pairs(self.folder / "pairs", count=1)
        (self.folder / "pairs/mask/quay_000.png").rename(self.folder / "kept.png")
        self.refuse(1, ["pairs/mask/quay_000.png", "missing"], "pairs", "--out", "x")
        (self.folder / "pairs/mask/quay_000.png").write_bytes(b"no image")
        self.refuse(1, ["pairs/mask/quay_000.png", "no PNG"], "pairs", "--out", "x", "--steps", "1")
        (self.folder / "empty").mkdir()
        self.refuse(1, ["empty/raw"], "empty", "--out", "x")
        self.refuse(2, ["nowhere", "quick"], "nowhere", "--out", "x")
        self.refuse(2, ["pairs", "no clean images"], "pairs", "--clean", "--out", "x")
        self.refuse(2, ["--val 'most'"], "pairs", "--val", "most", "--out", "x")
        self.refuse(2, ["whole number from 1"], "pairs", "--ngf", "0", "--out", "x")
        self.refuse(1, ["absent.pt"], "pairs", "--from", "absent.pt", "--out", "x", "--val", "0.5")
        (self.folder / "evil.pt").write_bytes(b"\x80\x04cos\nsystem\n(S'touch harmed'\ntR.")
        self.refuse(1, ["evil.pt"], "pairs", "--from", "evil.pt", "--out", "x", "--val", "0.5")
        self.assertFalse((self.folder / "harmed").exists())

    def test_the_modules_are_typed(self):
        if shutil.which("mypy", path="/usr/bin") is None:
            self.skipTest("no mypy here")
        done = subprocess.run(["/usr/bin/python3", "-m", "mypy", "--strict", "-p", "ensonify.training"], text=True,
                              cwd=arguments.build / "python", capture_output=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    arguments, rest = parser.parse_known_args()
    arguments.build, arguments.program = arguments.build.resolve(), arguments.program.resolve()
    unittest.main(argv=["training_test", *rest], verbosity=2)

#!/usr/bin/python3
"""Every example does what it says, and every one is run here."""

import pathlib
import re
import subprocess
import sys

import ensonify
from module_test_support import ModuleTest, main, read_grey

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "examples"


class Examples(ModuleTest):
    def example(self, name, *words):
        done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def numbers(self, pattern, text):
        found = [[float(number) for number in match.groups()] for match in re.finditer(pattern, text)]
        self.assertTrue(found, text)
        return found

    def test_first_ping(self):
        self.assertIn("pictures in pictures", self.example("first_ping.py", "pictures"))
        self.assertEqual(read_grey(self.folder / "pictures/raw.png").shape, (512, 512))
        self.assertEqual(sorted(p.name for p in (self.folder / "pictures").iterdir()), ["fan.png", "place.png", "raw.png"])

    def test_own_mesh(self):
        self.scene().save(self.folder / "block.obj")
        said = self.example("own_mesh.py", "block.obj", "pictures")
        self.assertEqual(len(self.numbers(r"from yaw +(\d+): nearest echo at ([\d.]+) m", said)), 4)
        self.assertTrue((self.folder / "pictures/four_sides.png").exists())

    def test_noise_sweep(self):
        rows = self.numbers(r"(?m)^ *([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+)$", self.example("noise_sweep.py", "pictures"))
        self.assertEqual(len(rows), 4)
        for _, psnr_raw, psnr_lee, _, _ in rows:
            self.assertGreater(psnr_lee, psnr_raw)
        self.assertEqual([row[1] for row in rows], sorted((row[1] for row in rows), reverse=True))

    def test_own_filter(self):
        rows = self.numbers(r"(?m)^[a-z ]+? +([\d.]+) +([\d.]+) +([\d.]+)$", self.example("own_filter.py", 3))
        self.assertEqual(len(rows), 5)
        self.assertEqual(min(rows)[0], rows[0][0], "raw has the least PSNR")

    def test_own_mapper(self):
        rows = self.numbers(r"coverage ([\d.]+), boundary found ([\d.]+)", self.example("own_mapper.py", 12))
        self.assertEqual(len(rows), 2)
        for coverage, found in rows:
            self.assertGreater(coverage, 0.6)
            self.assertGreater(found, 0.6)

    def test_train_on_the_fly(self):
        self.need_torch()
        (first, last), = self.numbers(r"first 5 steps ([\d.]+), of the last 5 ([\d.]+)", self.example("train_on_the_fly.py", 40))
        self.assertLess(last, 0.7 * first)

    def test_read_with_torch(self):
        self.need_torch()
        out = self.generate("set", recipe=self.recipe(train=16, test=2))
        said = self.example("read_with_torch.py", out)
        (echoes,), = self.numbers(r"echoes: ([\d.]+) %", said)
        dataset = ensonify.open_dataset(out)
        masks = [dataset.images("train", k, ["mask"])["mask"] for k in range(16)]
        self.assertAlmostEqual(echoes, 100 * sum((m > 0).mean() for m in masks) / 16, 1)
        shares = [share for share, in self.numbers(r"(?m)^  [a-z]+ +([\d.]+) %$", said)]
        self.assertAlmostEqual(sum(shares), 100, 1)

    def need_torch(self):
        try:
            import torch  # noqa: F401
        except ImportError:
            self.skipTest("python3-torch is not installed")

    def test_every_example_is_run(self):
        here = pathlib.Path(__file__).read_text()
        others = {"plugin_planner.py"}  # tests/cli/explore_test.py
        for example in EXAMPLES.glob("*.py"):
            if example.name not in others:
                self.assertIn(f'"{example.name}"', here)


if __name__ == "__main__":
    main()

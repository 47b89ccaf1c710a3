#!/usr/bin/python3
"""`ensonify reproduce --scale quick`: whole, killed and gone on with, and with inputs missing. Leaves its report in --folder
for the browser's test. Minutes."""

import argparse
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reports import Page
from support import ProgramTest, leftovers

PATIENCE_S = 1800 * float(os.environ.get("ENSONIFY_TEST_PATIENCE", 1))
VERDICTS = {"holds", "changes", "does not hold", "not measured"}
# Of every number file, but for times.csv, the only one by the clock.
NUMBERS = {"filters.csv", "filters.json", "realistic_filters.csv", "realistic_filters.json", "tank_filters.csv",
           "tank_filters.json", "tank_maps.csv", "tank_maps.json", "tank_maps_summary.csv", "closed_loop.csv",
           "conclusions.json"} | {f"{name}{end}" for name in ("maps", "maps_as_the_paper")
                                  for end in (".csv", ".json", "_summary.csv")}


def rows(path):
    with open(path) as file:
        return list(csv.DictReader(file))


class Reproduced(ProgramTest):
    report_folder = None  # of the whole run

    def command(self, out, *words):
        return [str(self.program), "reproduce", "--scale", "quick", "--out", str(out), "--progress", "none", *map(str, words)]

    def reproduce(self, out, *words, **environment):
        done = subprocess.run(self.command(out, *words), cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=PATIENCE_S, env=self.environment() | environment)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_1_a_whole_run(self):
        shutil.rmtree(self.report_folder, ignore_errors=True)
        said = self.reproduce(self.report_folder)
        self.assertEqual(said.splitlines()[-1], f"report: {self.report_folder}/report.html")
        numbers = self.report_folder / "numbers"
        self.assertEqual({f.name for f in numbers.iterdir()}, NUMBERS | {"times.csv"})
        self.assertEqual(leftovers(self.report_folder), [])
        self.check_conclusions(numbers, said)
        self.check_page(numbers)

    def check_conclusions(self, numbers, said):
        conclusions = json.loads((numbers / "conclusions.json").read_text())
        self.assertGreaterEqual(len(conclusions), 8)
        for conclusion in conclusions:
            self.assertIn(conclusion["verdict"], VERDICTS)
            self.assertRegex(said, f'(?m)^{conclusion["verdict"]} +{conclusion["claim"]}$')
        # The first, from the table of filters.
        scores = {(r["filter"], r["preset"], r["scene"]): r for r in rows(numbers / "filters.csv")}
        scenes = {scene for _, _, scene in scores} - {"all"}
        paper = [("lee_enhanced", "paper"), ("frost", "paper"), ("anisodiff", "paper"), ("wavelet", "paper")]
        best = [float(scores["unet", "paper", s]["masked_psnr_db"]) > max(float(scores[f, p, s]["psnr_db"]) for f, p in paper)
                for s in scenes]
        self.assertEqual(conclusions[0]["verdict"], "holds" if all(best) else "changes" if any(best) else "does not hold")
        # That of FNR, from the curves over all thresholds.
        held = []
        for file in ("maps.csv", "maps_as_the_paper.csv"):
            at = {(r["filter"], int(r["threshold"])): float(r["fnr"] or "nan") for r in rows(numbers / file)
                  if (r["scene"], r["model"], r["poses"]) == ("all", "points", "true")}
            self.assertEqual({t for _, t in at}, set(range(61)))
            held += [at["learned", t] <= min(at[f, t] for f in ("raw", *(f for f, _ in paper))) for t in range(61)]
        fnr, = [c for c in conclusions if "lowest FNR" in c["claim"]]
        self.assertEqual(fnr["verdict"], "holds" if all(held) else "changes" if any(held) else "does not hold")

    def check_page(self, numbers):
        page = Page((self.report_folder / "report.html").read_text())
        titles = [title for tag, title in page.headings if tag == "h2"]
        self.assertEqual(titles, ["Conclusions", "What is missing", "The sonar", "Filters", "Time a frame", "Occupancy maps",
                                  "The tank, and learning from few pairs", "Beyond the paper"])
        self.assertGreaterEqual(len(page.figures), 30)
        for figure, caption in zip(page.figures, page.captions):
            self.assertGreaterEqual(figure["svg"] + figure["img"], 1, caption)
            self.assertEqual(figure["missing"], 0, caption)
            self.assertTrue(figure["tables"], caption)
        self.assertFalse(page.tags & {"script", "link", "iframe", "object", "embed", "base"})
        theirs = {r["filter"]: r["the paper [s]"] for r in page.table("Seconds a frame").lines()}
        self.assertEqual({f: theirs[f] for f in ("lee_enhanced", "frost", "anisodiff", "wavelet", "learned")},
                         {"lee_enhanced": "8.75", "frost": "22.54", "anisodiff": "0.03", "wavelet": "0.04", "learned": "0.56"})
        missing = [r["what"] for r in page.table("Left out of this report").lines()]
        self.assertEqual(missing, ["real pings", "the paper's own pings, hand-labelled pairs and survey"])
        shown = {r["filter"]: r["PSNR [dB]"] for r in page.table("All filters that were judged").lines() if r["preset"] == "paper"}
        for row in rows(numbers / "filters.csv"):
            if row["scene"] == "all" and row["preset"] == "paper":
                self.assertAlmostEqual(float(shown[row["filter"]]), float(row["psnr_db"]), delta=0.0051)

    def test_2_killed_and_gone_on_with(self):
        """In the middle of the maps, by kill -9; the numbers are those of the whole run."""
        out = self.folder / "killed"
        running = subprocess.Popen(self.command(out, "--jobs", 1), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, env=self.environment())
        first_map = out / "kept_quick" / "maps" / "raw.json"
        begin = time.monotonic()
        while not first_map.exists():
            self.assertIsNone(running.poll(), "ended before its maps")
            self.assertLess(time.monotonic() - begin, PATIENCE_S)
            time.sleep(0.1)
        running.send_signal(signal.SIGKILL)
        running.wait()
        self.assertFalse((out / "report.html").exists())
        kept = {f: f.stat().st_mtime_ns for f in (first_map, out / "kept_quick" / "filters.json")}
        self.reproduce(out)
        self.assertEqual(kept, {f: f.stat().st_mtime_ns for f in kept})
        for name in NUMBERS:
            self.assertEqual((out / "numbers" / name).read_bytes(), (self.report_folder / "numbers" / name).read_bytes(), name)

    def test_3_inputs_that_are_missing(self):
        """No models, and a set of one's own without a val split and without truth."""
        data = self.folder / "data"
        shutil.copytree(self.program.parent / "share" / "ensonify", data, symlinks=False,
                        ignore=shutil.ignore_patterns("*.onnx", "*.cpp", "*.hpp"))
        self.recipe(train=4, test=4)
        self.succeed("generate", "small.yaml", "--out", "own", "--progress", "none")
        shutil.rmtree(self.folder / "own" / "grids")
        out = self.folder / "out"
        shutil.copytree(self.report_folder / "data_quick", out / "data_quick")
        shutil.copytree(self.report_folder / "kept_quick" / "loops", out / "kept_quick" / "loops")
        said = self.reproduce(out, "--data", "own", ENSONIFY_DATA=str(data))
        page = Page((out / "report.html").read_text())
        missing = {r["what"]: r["why"] for r in page.table("Left out of this report").lines()}
        self.assertIn("no frames in a split 'val'", missing["filters"])
        self.assertIn("no place of the dataset small has truth", missing["maps"])
        self.assertIn("--models", missing["the tank and sample efficiency"])
        self.assertIn("no model realistic.onnx", missing["the learned filter for the noise of realistic"])
        for what in missing:
            if what != "the paper's own pings, hand-labelled pairs and survey":
                self.assertRegex(said, f"(?m)^missing +{what}: ")
        self.assertEqual({f.name for f in (out / "numbers").iterdir()},
                         {"realistic_filters.csv", "realistic_filters.json", "closed_loop.csv", "times.csv", "conclusions.json"})
        verdicts = {c["verdict"] for c in json.loads((out / "numbers" / "conclusions.json").read_text())}
        self.assertEqual(verdicts, {"not measured"})
        for figure, caption in zip(page.figures, page.captions):
            self.assertGreaterEqual(figure["svg"] + figure["img"], 1, caption)

    def test_4_wrong_words(self):
        self.refuse(2, ["--scale"], "reproduce", "--out", "o", "--scale", "huge")
        self.refuse(1, ["nowhere"], "reproduce", "--out", "o", "--data", "nowhere")
        self.refuse(1, ["nowhere"], "reproduce", "--out", "o", "--real", "nowhere")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--folder", type=pathlib.Path, required=True, help="where the whole run stays")
    arguments, rest = parser.parse_known_args()
    ProgramTest.program = arguments.program.resolve()
    Reproduced.report_folder = arguments.folder.resolve()
    unittest.main(argv=["reproduce", *rest], verbosity=2)

#!/usr/bin/python3
"""The pages that --html writes, read as text: well formed, self-contained, with the numbers of the other files."""

import csv
import json
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from reports import COMMANDS, NASTY, SCENE_NAME, Page, ReportTest
from support import leftovers, main


class Pages(ReportTest):
    def test_they_stand_beside_the_other_files_and_the_last_line_says_so(self):
        for name in COMMANDS:
            self.assertEqual(self.said[name].splitlines()[-1], f"report: {self.made}/out/{name}")
        for name in ("stats.json", "stats.png", "filters.csv", "filters.png", "map.csv", "curves_drifted.png"):
            self.assertTrue((self.made / "out" / name).is_file(), name)
        self.assertEqual(leftovers(self.made), [])

    def test_they_are_well_formed_and_in_order(self):
        for name in COMMANDS:
            page = self.page(name)
            levels = [int(tag[1]) for tag, _ in page.headings]
            self.assertEqual(levels.count(1), 1)
            self.assertEqual(levels[0], 1)
            self.assertTrue(all(b <= a + 1 for a, b in zip(levels, levels[1:])), levels)
            self.assertIn(("html", "lang", "en"), page.attributes)
            ids = [value for _, key, value in page.attributes if key == "id"]
            self.assertEqual(len(ids), len(set(ids)))
            targets = [value[1:] for _, key, value in page.attributes if key == "href"]
            self.assertGreater(len(targets), 4)
            self.assertLessEqual(set(targets), set(ids))
            for tag, key, value in page.attributes:
                self.assertFalse(key in ("alt", "aria-label", "scope") and not value, (tag, key))

    def test_they_need_nothing_else(self):
        for name in COMMANDS:
            page = self.page(name)
            self.assertFalse(page.tags & {"script", "link", "iframe", "object", "embed", "base"})
            for tag, key, value in page.attributes:
                if key in ("href", "src"):
                    self.assertTrue(value.startswith(("#", "data:image/png;base64,")), (tag, value[:80]))
                self.assertNotRegex(value, r"https?://", (tag, key))
                self.assertFalse(key.startswith("on"), (tag, key))
            self.assertNotRegex(self.text(name), r"@import|url\(|@font-face")
            self.assertNotIn(str(self.made), self.text(name))

    def test_every_figure_has_its_picture_a_caption_and_a_table(self):
        least = {"stats.html": 13, "filters.html": 9, "map.html": 22}
        for name in COMMANDS:
            page = self.page(name)
            self.assertGreaterEqual(len(page.figures), least[name])
            for figure, caption in zip(page.figures, page.captions):
                self.assertGreaterEqual(figure["svg"] + figure["img"], 1, caption)
                self.assertTrue(figure["tables"], caption)
                for words in (r"^Figure \d+\. ", r"\d+ frames|each place", "Dataset reported, seed 5, root hash [0-9a-f]{12}…"):
                    self.assertRegex(caption, words)

    def test_texts_from_outside_stay_texts(self):
        for name in COMMANDS:
            for bad in ("<script", "<i>", 'onload="', "</title><"):
                self.assertNotIn(bad, self.text(name))
        stats = self.page("stats.html")
        self.assertEqual(stats.facts["Dataset"], f"reported: {NASTY}")
        scene = SCENE_NAME.removesuffix(".yaml")
        self.assertIn(scene, {line["scene"] for line in stats.table("Places").lines()})

    def test_the_same_bytes_for_the_same_dataset(self):
        for name in COMMANDS:
            self.report(name, "again", "--jobs", 1)
            texts = [self.text(name), (self.folder / "again" / name).read_text()]
            if name == "filters.html":  # times alone differ
                texts = [text[:text.index('<h2 id="s-times">')] for text in texts]
            self.assertEqual(*texts)


class Numbers(ReportTest):
    def close(self, shown, exact):
        """`shown` is `exact` rounded to its digits."""
        if exact in ("", None):
            self.assertEqual(shown, "–")
            return
        digits = len(shown.partition(".")[2])
        self.assertAlmostEqual(float(shown), float(exact), delta=0.51 * 10.0 ** -digits)

    def rows(self, name, **where):
        with (self.made / "out" / name).open() as file:
            return [row for row in csv.DictReader(file) if all(row[k] == v for k, v in where.items())]

    def test_of_filters(self):
        page = self.page("filters.html")
        rows = self.rows("filters.csv", scene="all")
        columns = {"t": "threshold", "PSNR [dB]": "psnr_db", "SSIM": "ssim", "edges": "edge_preservation", "looks": "looks",
                   "precision": "precision", "recall": "recall", "IoU": "iou", "F1": "f1", "gated PSNR [dB]": "gated_psnr_db",
                   "masked PSNR [dB]": "masked_psnr_db", "masked SSIM": "masked_ssim"}
        self.assertEqual({row["ghosts_removed"] for row in rows}, {""})  # open water: no such column, no such figure
        self.assertNotIn("Ghosts", self.text("filters.html"))
        lines = page.table("Scores over all scenes").lines()
        self.assertEqual([(line["filter"], line["preset"]) for line in lines], [(r["filter"], r["preset"]) for r in rows])
        for line, row in zip(lines, rows):
            self.assertEqual(set(line) - {"filter", "preset"}, set(columns))
            for shown, key in columns.items():
                self.close(line[shown], row[key])
        for title, unit, key in (("PSNR", "PSNR [dB]", "psnr_db"), ("IoU of", "IoU", "iou"), ("Edges", "correlation",
                                                                                           "edge_preservation")):
            lines = page.table(title).lines()
            self.assertEqual(len(lines), len(rows))
            for line, row in zip(lines, rows):
                for shown, end in ((unit, ""), ("95 % from", "_low"), ("to", "_high")):
                    self.close(line[shown], row[key + end])
        for line, row in zip(page.table("Median time").lines(), self.rows("times.csv", scene="all")):
            self.close(line["all"], row["median_ms"])

    def test_of_maps(self):
        page = self.page("map.html")
        for scene, caption in (("all", "Scores over all places"), ("block_layout1", "Scores in block_layout1")):
            lines, rows = page.table(caption).lines(), self.rows("summary.csv", scene=scene)
            self.assertEqual(len(lines), len(rows))
            for line, row in zip(lines, rows):
                self.assertEqual((line["filter"], line["model"], line["poses"]), (row["filter"], row["model"], row["poses"]))
                for shown, key in (("t", "best_threshold"), ("FPR", "fpr"), ("FNR", "fnr"), ("F1 k1", "f1_k1"),
                                   ("balanced accuracy", "balanced_accuracy"), ("FNR at FPR 0.05", "fnr_at_fpr_0.05"),
                                   ("loss coverage", "loss_coverage")):
                    self.close(line[shown], row[key])
        curves = {(r["threshold"], r["filter"]): r for r in self.rows("map.csv", scene="all", model="points", poses="true")}
        for figure, key in zip(page.figures, ("fpr", "fnr", "balanced_accuracy", "coverage", "f1_k1")):
            lines = figure["tables"][0].lines()
            self.assertEqual(len(lines), 21)
            for line in lines:
                for name in ("clean", "raw"):
                    self.close(line[name], curves[line["threshold t [grey level]"], name][key])

    def test_of_stats(self):
        page = self.page("stats.html")
        stats = json.loads((self.made / "out/stats.json").read_text())
        groups = {**stats["splits"], "all": stats["overall"]}
        for line in page.table("Splits").lines():
            figures = groups[line["split"]]
            self.assertEqual(line["frames"], str(figures["frames"]))
            self.close(line["mask share, median [%]"], 100 * figures["mask_share"]["percentiles"]["50"])
        for line in page.table("Pixels by label").lines():
            for shown, key in (("water", "water"), ("direct echo", "direct"), ("shadow", "shadow")):
                self.close(line[shown], 100 * groups[line["split"]]["label_share"][key])
        levels = page.table("Share of pixels [%] at each grey level").lines()
        self.assertEqual(len(levels), 256)
        for line in levels:
            for split in stats["splits"]:
                counts = stats["splits"][split]["raw_histogram"]
                self.close(line[split], 100 * counts[int(line["grey level"])] / sum(counts))
        for split in stats["splits"]:
            shown = [line[split] for line in page.table("Numbers of the curves: mean grey level").lines()]
            for text, exact in zip(shown, stats["splits"][split]["range"]["raw_level"], strict=True):
                self.close(text, exact)


class Refused(ReportTest):
    def test_what_does_not_go_together(self):
        self.refuse(2, ["--json", "--html"], "stats", "set", "--html", "--json")
        self.refuse(2, ["--against", "--html"], "stats", "set", "--html", "--against", "set/val/raw")
        self.refuse(2, ["--tune", "--html"], "evaluate", "filters", "set", "--html", "--tune", "--out", "o")
        self.assertFalse((self.folder / "set/stats").exists())


class WithoutGnuplot(ReportTest):
    path = os.environ["PATH"]

    def environment(self):
        return {**super().environment(), "PATH": self.path}

    def test_the_tables_remain_and_the_page_says_what_is_missing(self):
        self.path = "/nonexistent"
        for name in COMMANDS:
            done = self.report(name, "bare")
            text = (self.folder / "bare" / name).read_text()
            self.assertIn("gnuplot-nox", text)
            self.assertIn("gnuplot-nox", done.stderr)
            self.assertNotIn("<svg", text)
            self.assertEqual([(t.caption, t.rows) for t in Page(text).tables if "time" not in t.caption],
                             [(t.caption, t.rows) for t in self.page(name).tables if "time" not in t.caption])
        self.assertFalse(list((self.folder / "bare").glob("curves*.png")))
        self.assertTrue((self.folder / "bare/map.csv").is_file())
        self.refuse(1, ["gnuplot-nox"], "stats", "set", "--progress", "none")


if __name__ == "__main__":
    main()

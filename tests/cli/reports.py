"""The three report pages of a small dataset, and a reader of such pages: for report_test.py and the browser's test."""

import html.parser
import pathlib
import shutil
import tempfile

from support import SCENE, ProgramTest

# A title is free text: this one tries to leave tags and quotes. Names of scenes hold neither < nor quotes (generate
# refuses them), but & they may.
NASTY = """</title><script>alert('1')</script>" onload="alert(2)"""
RECIPE = """name: reported
title: %s
seed: 5
sonar: {model: small_sonar.yaml, range_max_m: 8, range_bins: 128, gain_db: {uniform: [-3, 3]}}
noise: paper
splits:
  train:
    frames: 8
    places: [{scene: "%s", layouts: [0, 1]}]
    random_poses: {pitch_deg: {uniform: [0, 30]}, least_seen_share: 0.05}
  val:
    frames: 4
    places: [{scene: block.yaml, layouts: [3]}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
  test:
    frames: 6
    places: [{scene: block.yaml, layouts: [1, 2]}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
"""
SCENE_NAME = "b&lt;i&gt;.yaml"

COMMANDS = {"stats.html": ["stats", "set", "--columns", 3],
            "filters.html": ["evaluate", "filters", "set"],
            "map.html": ["evaluate", "map", "set", "--filter", "clean", "--filter", "raw", "--model", "points", "--model", "carve",
                         "--poses", "both", "--threshold-max", 20]}


class ReportTest(ProgramTest):
    made = None  # the set and its pages, once for all tests of a class
    said = {}

    def setUp(self):
        super().setUp()
        if ReportTest.made is None:
            ReportTest.made = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_reports_"))
            self.addClassCleanup(self.forget)
            self.write(SCENE_NAME, SCENE)
            quoted = [text.replace("\\", "\\\\").replace('"', '\\"') for text in (NASTY, SCENE_NAME)]
            self.write("reported.yaml", RECIPE % (f'"{quoted[0]}"', quoted[1]))
            self.generate(self.made / "set", recipe="reported.yaml")
            shutil.copytree(self.made / "set", self.folder / "set")
            ReportTest.said = {name: self.report(name, self.made / "out").stdout for name in COMMANDS}
        else:
            shutil.copytree(self.made / "set", self.folder / "set")

    @staticmethod
    def forget():
        shutil.rmtree(ReportTest.made)
        ReportTest.made = None

    def report(self, name, out, *words):
        return self.succeed(*COMMANDS[name], "--out", out, "--html", "--progress", "none", *words)

    def text(self, name):
        return (self.made / "out" / name).read_text()

    def page(self, name):
        return Page(self.text(name))


class Table:
    def __init__(self):
        self.caption, self.rows = "", []

    def columns(self):
        return self.rows[0]

    def lines(self):
        return [dict(zip(self.rows[0], row)) for row in self.rows[1:]]


class Page(html.parser.HTMLParser):
    """Tags must be closed in order. Collects attributes, headings, figures (with their tables and pictures) and tables."""

    VOID = {"meta", "img", "br", "hr", "link"}

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.attributes, self.headings, self.figures, self.tables, self.captions = [], [], [], [], [], []
        self.tags, self.facts = set(), {}
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.attributes += [(tag, key, value or "") for key, value in attrs]
        if tag not in self.VOID:
            self.open.append(tag)
        if tag in ("h1", "h2", "h3", "h4"):
            self.headings.append([tag, ""])
        if tag == "figure":
            self.figures.append({"tables": [], "svg": 0, "img": 0, "missing": 0})
            self.captions.append("")
        if "figure" in self.open:
            if tag in ("svg", "img"):
                self.figures[-1][tag] += 1
            if ("class", "missing") in attrs:
                self.figures[-1]["missing"] += 1
        if tag == "table":
            self.tables.append(Table())
            if "figure" in self.open:
                self.figures[-1]["tables"].append(self.tables[-1])
        if tag == "tr":
            self.tables[-1].rows.append([])
        if tag in ("td", "th"):
            self.tables[-1].rows[-1].append("")

    def handle_startendtag(self, tag, attrs):
        raise AssertionError(f"<{tag}/> closes nothing in HTML")

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()

    def handle_data(self, data):
        where = self.open[-1] if self.open else ""
        if where in ("h1", "h2", "h3", "h4"):
            self.headings[-1][1] += data
        if where in ("td", "th"):
            self.tables[-1].rows[-1][-1] += data
        if where == "dt":
            self.fact = data
        if where == "dd":
            self.facts[self.fact] = self.facts.get(self.fact, "") + data
        if "caption" in self.open:
            self.tables[-1].caption += data
        if "figcaption" in self.open:
            self.captions[-1] += data

    def table(self, caption):
        found = [t for t in self.tables if t.caption.startswith(caption)]
        assert found, (caption, [t.caption for t in self.tables])
        return found[0]

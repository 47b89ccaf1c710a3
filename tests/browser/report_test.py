#!/usr/bin/python3
"""Report pages in a browser, as wide as a desk's and as a phone's, light and dark: nothing is loaded, nothing complains,
nothing is cut off. Leaves pictures of the pages to look at. See CONTRIBUTING.md."""

import argparse
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]
import chromium
from reports import COMMANDS, ReportTest
from support import ProgramTest

WINDOWS = {"desktop": (1280, 900), "phone": (390, 844)}
SCHEMES = ("light", "dark")
# Boxes of all figures' pictures, and whether each lies within the window.
BOXES = """[...document.querySelectorAll('figure > svg, figure img')].map(e => {
  const box = e.getBoundingClientRect();
  return [box.width > 20 && box.height > 10 && box.left >= -1 && box.right <= innerWidth + 1 &&
          (e.tagName != 'IMG' || e.naturalWidth > 0), e.tagName + ' ' + box.width + ' x ' + box.height];
})"""
# Contrast of what plots are drawn with against the page (WCAG 2.2, relative luminance), the lowest of all; no grid lines.
CONTRAST = """(() => {
  const canvas = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
  const light = colour => {
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data].slice(0, 3).map(v => v / 255)
      .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
      .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  };
  const paper = light(getComputedStyle(document.body).backgroundColor);
  return Math.min(...[...document.querySelectorAll('svg path, svg text, svg polygon')].flatMap(e => {
    if ((e.getAttribute('stroke') || '').includes('cccccc')) return [];
    const style = getComputedStyle(e);
    const paint = style.stroke != 'none' ? style.stroke : style.fill;
    return paint == 'none' ? [] : [(Math.max(light(paint), paper) + 0.05) / (Math.min(light(paint), paper) + 0.05)];
  }));
})()"""
# As in many tables: their own box scrolls, so that the page need not.
WIDE_TABLES = "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth).length"


@unittest.skipUnless(chromium.program(), "no chromium here (Debian: chromium)")
class Pages(ReportTest):
    pictures = None
    page_file = None  # looked at in place of the pages of a small dataset

    def setUp(self):
        if self.page_file is None:
            super().setUp()
        else:
            ProgramTest.setUp(self)  # needs no pages of its own
        self.browser = chromium.Browser()
        self.addCleanup(self.browser.close)

    def views(self):
        pages = [self.page_file] if self.page_file else [self.made / "out" / name for name in COMMANDS]
        for page in pages:
            for window, size in WINDOWS.items():
                for scheme in SCHEMES:
                    events = self.browser.open(page.as_uri(), *size, scheme)
                    with self.subTest(page=page.name, window=window, scheme=scheme):
                        yield page.name, window, scheme, page.as_uri(), events

    def test_pages(self):
        for name, window, scheme, url, events in self.views():
            said = [e for e in events if e.get("method") in ("Log.entryAdded", "Runtime.consoleAPICalled",
                                                             "Runtime.exceptionThrown")]
            self.assertEqual(said, [])
            asked = {e["params"]["request"]["url"] for e in events if e.get("method") == "Network.requestWillBeSent"}
            self.assertEqual({u for u in asked if not u.startswith("data:image/png;base64,")}, {url})
            self.assertEqual(self.browser.value("innerWidth"), WINDOWS[window][0])
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), WINDOWS[window][0])
            boxes = self.browser.value(BOXES)
            self.assertGreater(len(boxes), 10)
            self.assertEqual([size for whole, size in boxes if not whole], [])
            self.assertGreater(self.browser.value(CONTRAST), 2)
            if window == "phone":
                self.assertGreater(self.browser.value(WIDE_TABLES), 0)
            # Unfolded tables must not widen the page either.
            self.browser.value("document.querySelectorAll('details').forEach(d => d.open = true)")
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), WINDOWS[window][0])
            self.browser.value("document.querySelectorAll('details').forEach(d => d.open = false)")
            self.keep(f"{pathlib.Path(name).stem}_{window}_{scheme}.png")

    def keep(self, name):
        if self.pictures:
            self.pictures.mkdir(parents=True, exist_ok=True)
            self.browser.screenshot(self.pictures / name)

    def test_dark_pages_are_dark_and_light_ones_light(self):
        for _, _, scheme, _, _ in self.views():
            paper = self.browser.value("getComputedStyle(document.body).backgroundColor")
            self.assertEqual(paper, {"light": "rgb(255, 255, 255)", "dark": "rgb(20, 23, 26)"}[scheme])

    def test_what_is_wrong_is_seen(self):
        """Shows that the checks above can fail."""
        page = self.write("bad.html", "<!DOCTYPE html><body style='margin:0'><div style='width:2000px'>wide</div><img src="
                          "'http://127.0.0.1:9/x.png'><script>console.error('bad')</script><figure><svg width=1></svg>")
        events = self.browser.open(page.as_uri(), 1280, 900, "light")
        methods = {e.get("method") for e in events}
        self.assertIn("Runtime.consoleAPICalled", methods)
        self.assertIn("http://127.0.0.1:9/x.png", {e["params"]["request"]["url"] for e in events
                                                   if e.get("method") == "Network.requestWillBeSent"})
        self.assertGreater(self.browser.value("document.documentElement.scrollWidth"), 1280)
        self.assertFalse(self.browser.value(BOXES)[0][0])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for pictures of the pages")
    parser.add_argument("--report", type=pathlib.Path, help="a page to look at in place of those of a small dataset")
    arguments, rest = parser.parse_known_args()
    ReportTest.program = arguments.program.resolve()
    Pages.pictures = arguments.pictures
    Pages.page_file = arguments.report
    unittest.main(argv=["browser", *rest], verbosity=2)

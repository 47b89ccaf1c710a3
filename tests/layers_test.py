#!/usr/bin/python3
"""Every include goes only where the tables of ARCHITECTURE.md allow; those tables are read from there."""

import argparse
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)


def table(text, first_column):
    """Rows of the markdown table whose header starts with `first_column`, as lists of cells without back quotes."""
    rows = []
    inside = False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and cells[0] == first_column:
            inside = True
        elif inside and not line.startswith("|"):
            break
        elif inside and not set(line) <= set("|-: "):
            rows.append([cell.replace("`", "") for cell in cells])
    return rows


def names(cell):
    return [name.strip().rstrip("/") for name in cell.split(",") if name.strip() not in ("", "none")]


def read_rules(text):
    rooms = {row[0].rstrip("/"): names(row[-1]) for row in table(text, "room")}
    libraries = [(names(row[1]), names(row[2])) for row in table(text, "library")]
    return rooms, libraries


def violations(rooms, libraries, room, source):
    """What is wrong with the includes of a source text that lives in `room`."""
    found = []
    for path in INCLUDE.findall(source):
        parts = path.split("/")
        if parts[0] == "ensonify":
            if len(parts) < 3:
                found.append(f"{path}: own headers are included as ensonify/<room>/<file>")
            elif parts[1] != room and parts[1] not in rooms[room]:
                found.append(f"{room} must not include {path}; it may include {', '.join(rooms[room]) or 'no room'}")
        for headers, allowed in libraries:
            if any(path == h or path.startswith(h + "/") for h in headers) and room not in allowed:
                found.append(f"{room} must not include {path}; only {', '.join(allowed)} may")
    return found


class LayersTest(unittest.TestCase):
    def setUp(self):
        self.rooms, self.libraries = read_rules((ROOT / "ARCHITECTURE.md").read_text())

    def test_the_table_has_every_room_and_no_circle(self):
        with_code = {f.parent.name for f in ROOT.glob("*/CMakeLists.txt")} - {"tests", "bench"}
        self.assertEqual(set(self.rooms), with_code)
        above = set()
        for room, allowed in self.rooms.items():
            self.assertLessEqual(set(allowed), above, f"{room} may include only rooms above it in the table")
            above.add(room)

    def test_every_include_keeps_the_rules(self):
        wrong = []
        count = 0
        for room in self.rooms:
            for file in sorted((ROOT / room).rglob("*")):
                if file.suffix in (".hpp", ".cpp", ".in"):
                    count += 1
                    wrong += [f"{file.relative_to(ROOT)}: {v}"
                              for v in violations(self.rooms, self.libraries, room, file.read_text())]
        self.assertGreater(count, 100)
        self.assertEqual(wrong, [])

    def test_a_violation_is_caught(self):
        table_of = [("sim", '#include "ensonify/generators/recipe.hpp"'),
                    ("core", '#include "ensonify/config/reader.hpp"'),
                    ("output", '#  include "ensonify/sim/voxelize.hpp"'),
                    ("noise", "#include <embree3/rtcore.h>"),
                    ("generators", "#include <assimp/scene.h>"),
                    ("sim", "#include <CLI/CLI.hpp>"),
                    ("core", '#include "ensonify/pose.hpp"')]
        for room, line in table_of:
            with self.subTest(line):
                self.assertEqual(len(violations(self.rooms, self.libraries, room, f"// fine\n{line}\nint x;\n")), 1)
        self.assertEqual(violations(self.rooms, self.libraries, "sim", '#include "ensonify/core/pose.hpp"\n'), [])


if __name__ == "__main__":
    argparse.ArgumentParser().parse_args()
    unittest.main(verbosity=2)

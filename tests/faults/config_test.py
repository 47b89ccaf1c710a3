#!/usr/bin/python3
"""Configuration and names made to hurt, and limits: refused with a place and a rule, within seconds and bounded memory."""

import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from faults import TINY, FaultTest  # noqa: E402
from support import SCENE, SONAR, main  # noqa: E402

NOISE = "name: own\nstages:\n  - {stage: gaussian_speckle, sigma: 0.1}\n"
LETTERS = "abcdefghijklmnopqrstuvwxyz"


def bomb():
    text = "a: &a [" + ",".join("x" * 9) + "]\n"
    for a, b in zip(LETTERS, LETTERS[1:]):
        text += f"{b}: &{b} [" + ",".join([f"*{a}"] * 9) + "]\n"
    return text + "<<: *z\nname: *z\ntitle: *z\n"


# Not one of them is a configuration of any kind.
TEXTS = {
    "empty": "", "blank": " \n\n", "comment": "# nothing\n", "null": "~\n", "word": "word\n", "list": "- a\n- b\n",
    "bomb": bomb(),
    "deep lists": "a: " + "[" * 100_000, "deep mappings": "a: " + "{a: " * 100_000, "deep keys": "? " * 100_000,
    "deep blocks": "\n".join(" " * i + "- " for i in range(1500)), "deep dashes": "- " * 100_000,
    "deep and whole": "a: " + "[" * 50_000 + "]" * 50_000 + "\n",
    "many keys": "".join(f"k{i}: 1\n" for i in range(50_000)),
    "one key": "k" * 3_000_000 + ": 1\n", "one value": "name: " + "v" * 3_000_000 + "\n",
    "nul": "name: a\0b\n", "garbage": bytes((i * 97 + 13) % 256 for i in range(100_000)),
    "utf-16": "name: x\n".encode("utf-16"), "latin": b"name: \xe9t\xe9\n", "tab": "name: x\n\ttitle: y\n",
    "tag": "!!python/object/apply:os.system ['touch hurt']\n", "tagged": "name: !!python/name:os.system x\n",
    "two documents": "name: a\n---\nname: b\n", "open quote": 'name: "x\n', "open list": "a: [1, 2\n",
    "cycle": "a: &a [*a]\n", "no anchor": "a: *b\n", "directive": "%YAML 99.9\n---\nname: x\n", "bell": "name: \a\n",
    "escape": 'name: "\\e[31mred"\n', "brackets": "]" * 100_000, "questions": "?" * 100_000, "colons": ":" * 100_000,
    "percent": "%" * 100_000, "bars": "|\n" * 100_000, "quotes": "'" * 100_001, "ampersands": "&" * 100_000,
    "anchors": "a: " + "".join(f"&a{i} " for i in range(50_000)) + "\n", "commas": "[" + "," * 100_000 + "]",
    "flow keys": "{" + "? : , " * 50_000 + "}", "large": "a: 1\n" * 1_000_000,
}
COMMANDS = {
    "scene": ("scene", "check", "bad.yaml"),
    "sonar": ("sonar", "check", "bad.yaml"),
    "noise": ("ping", "block.yaml", "--sonar", "small_sonar.yaml", "--pose", "0 0 -1 0 0 0", "--out", "out", "--noise",
              "bad.yaml"),
    "recipe": ("generate", "bad.yaml", "--out", "out", "--progress", "none"),
}
GOOD = {"scene": SCENE, "sonar": SONAR, "noise": NOISE, "recipe": TINY}


class Texts(FaultTest):
    def test_no_text_stops_the_reader(self):
        for i, (what, text) in enumerate(TEXTS.items()):
            with self.subTest(what):
                self.write("bad.yaml", text)
                command = list(COMMANDS.values())[i % 2]  # one reader serves them all
                code, said = self.measured(*command)
                self.assertEqual(code, 2, said[:300])
                self.assertTrue(said.startswith("ensonify: bad.yaml"), said[:300])
                self.assertLess(len(said), 4000)
        self.assertFalse((self.folder / "hurt").exists())

    def test_every_kind_of_file_goes_through_it(self):
        for kind, words in COMMANDS.items():
            self.write("bad.yaml", GOOD[kind])
            for what in ("bomb", "deep lists", "two documents"):
                with self.subTest(f"{kind} {what}"):
                    self.write("bad.yaml", TEXTS[what])
                    self.complain([2], ["bad.yaml"], *words)
            for old, new, rule in (("name: ", "name: !!python/name:os.system ", None), ("name: ", "<<: {a: 1}\nname: ", "<<"),
                                   ("name: ", "name: ok\nname: ", "given twice"), ("name: ", "nmae: x\nname: ", "nmae")):
                text = GOOD[kind] if GOOD[kind].startswith("name: ") else "name: x\n" + GOOD[kind]
                self.write("bad.yaml", text.replace(old, new, 1))
                if rule:
                    self.complain([2], ["bad.yaml:", rule], *words)
        self.assertFalse((self.folder / "out").exists())

    def test_numbers(self):
        for number in ("1e999", "-1e999", ".nan", ".inf", "-.inf", "0x", "99999999999999999999999", "1_000", "1,5", "1e", "",
                       "[]", "{}", "null", "-0x10", "1e-999x", "٣", "1 2", "true", "0b1"):
            with self.subTest(number):
                self.write("bad.yaml", SONAR.replace("count: 48", f"count: {number}"))
                self.complain([2], ["bad.yaml:", "beams"], *COMMANDS["sonar"])

    def test_what_is_no_file_is_not_waited_for(self):
        os.mkfifo(self.folder / "pipe.yaml")
        (self.folder / "folder.yaml").mkdir()
        (self.folder / "loop.yaml").symlink_to("loop.yaml")
        self.write("huge.yaml", "")
        os.truncate(self.folder / "huge.yaml", 100 << 20)
        for name in ("pipe.yaml", "folder.yaml", "loop.yaml", "/dev/zero", "/dev/stdin", "huge.yaml", "/proc/self/mem", "",
                     "n" * 5000 + ".yaml", "gone.yaml"):
            with self.subTest(name[:20]):
                self.complain([2], [], *[name if w == "bad.yaml" else w for w in COMMANDS["noise"]])
        for words in COMMANDS.values():
            self.complain([2], ["pipe.yaml"], *["pipe.yaml" if w == "bad.yaml" else w for w in words])
        for name in ("pipe.obj", "folder.obj", "zero.obj", "pipe.txt", "zero.txt"):
            path = self.folder / name
            os.mkfifo(path) if "pipe" in name else path.mkdir() if "folder" in name else path.symlink_to("/dev/zero")
        for name in ("pipe.obj", "folder.obj", "zero.obj", "/dev/zero.obj"):
            self.complain([1, 2], [name], "scene", "check", name)
        for name in ("pipe.txt", "zero.txt", "/dev/zero", "folder.yaml", "loop.yaml"):
            self.swim(name)
            self.complain([1, 2], [name], *COMMANDS["recipe"])

    def swim(self, name):
        self.write("bad.yaml", TINY.replace("trajectory: {speed_mps: 0.5, rate_hz: 2}", f"trajectory: {{file: {name}}}"))

    def test_trajectories(self):
        line = "0 0 0 -2 0 0 0 1\n"
        for what, text in {"empty": "", "nan": line + "1 nan 0 -2 0 0 0 1\n", "inf": line + "1 1e999 0 -2 0 0 0 1\n",
                           "long line": "1 " * 2_000_000, "long word": "1" * 3_000_000, "binary": bytes(range(256)) * 1000,
                           "nul": line + "1 0 0 -2 0 0 0 1\0\n", "far": line + "1e300 0 0 -2 0 0 0 1\n",
                           "back": line + line, "no turn": line + "1 0 0 -2 0 0 0 0\n", "comments": "#" * 100_000 + "\n",
                           "hex": line + "0x1 0 0 -2 0 0 0 1\n", "long": "".join(f"{i}e-3 0 0 -2 0 0 0 1\n" for i in range(50_000)),
                           "late": line + "900000000000 3 3 -2 0 0 0 1\n"}.items():
            with self.subTest(what):
                self.write("way.txt", text)
                self.swim("way.txt")
                code, said = self.measured(*COMMANDS["recipe"])
                self.assertIn(code, (0, 1, 2) if what in ("long", "late") else (1, 2), said[:300])
                if code:
                    self.assertIn("ensonify: ", said)
                    self.assertLess(len(said), 2000)


class Names(FaultTest):
    NAMES = {"up": "../x", "root": "/tmp/x", "dots": "..", "dot": ".", "slash": "a/b", "dash": "-rf", "line": "a\\nb",
             "nul": "a\\0b", "bell": "a\\ab", "long": "n" * 300, "longest": "n" * 5000, "fish": "\U0001f41f", "blank": " ",
             "quote": '\\"', "empty": "", "colon": "a: b", "colour": "\\e[31m", "percent": "{}%s%n"}

    def test_no_name_leads_out_of_the_folder(self):
        inner = self.folder / "inner"
        inner.mkdir()
        for name in ("small_sonar.yaml", "block.yaml"):
            (self.folder / name).rename(inner / name)
        before = sorted(self.folder.iterdir())
        for what, name in self.NAMES.items():
            with self.subTest(what):
                quoted = f'"{name}"'
                self.write("inner/scene.yaml", f"name: {quoted}\n" + SCENE.replace("- name: block", f"- name: {quoted}")
                           .replace("title: a block on a flat bottom", f"title: {quoted}"))
                self.write("inner/sonar.yaml", SONAR.replace("name: small", f"name: {quoted}").replace("title: small test sonar", f"title: {quoted}"))
                self.write("inner/noise.yaml", NOISE.replace("name: own", f"name: {quoted}"))
                recipe = (TINY.replace("name: tiny", f"name: {quoted}").replace("title: tiny", f"title: {quoted}")
                          .replace("block.yaml", "scene.yaml").replace("small_sonar.yaml", "sonar.yaml")
                          .replace("noise: paper", "noise: noise.yaml").replace("frames: 20", "frames: 2"))
                self.write("inner/recipe.yaml", recipe)
                bad = what in ("line", "nul", "bell", "longest", "colour")
                out = f"inner/out_{what}"
                code, _, err = self.run_limited("generate", "inner/recipe.yaml", "--out", out, "--progress", "none")
                self.assertEqual(code, 2 if bad else 0, err)
                if bad:
                    self.assertRegex(err, r"inner/\w+\.yaml:\d+: .*(control characters|at most 1000 bytes)")
                else:
                    self.succeed("verify", out)
                    head = (self.folder / out / "README.md").read_text().split("---")[1]
                    self.assertEqual(len([line for line in head.splitlines() if line.startswith("pretty_name")]), 1)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_file_names_that_name_files_of_the_dataset(self):
        for name in ("-rf", ".hidden", "a b", "a\nb", 'a"b', "n" * 101, "a\\b", "a:b", "...", "a\x7fb"):
            with self.subTest(name):
                self.write(f"{name}.yaml", SCENE)
                text = TINY.replace("block.yaml", '"' + f"./{name}.yaml".replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
                                    .replace("\x7f", "\\x7f") + '"')
                self.write("recipe.yaml", text)
                self.complain([2], ["recipe.yaml:"], "generate", "recipe.yaml", "--out", "out")
        self.write("\U0001f41f.yaml", SCENE)
        self.write("n" * 100 + ".yaml", SCENE)
        for name in ("\U0001f41f", "n" * 100):
            self.write("recipe.yaml", TINY.replace("block.yaml", f"{name}.yaml").replace("frames: 20", "frames: 2"))
            self.generate("out" + name[:3], recipe="recipe.yaml")
            self.succeed("verify", "out" + name[:3])

    def test_splits_have_no_other_names(self):
        for name in ("..", "/tmp", "train/../x", "Train"):
            self.write("recipe.yaml", TINY.replace("  train:", f'  "{name}":'))
            self.complain([2], ["recipe.yaml:", "unknown key"], "generate", "recipe.yaml", "--out", "out")

    def test_odd_folders_are_written_to(self):
        for name in ("-out", "a b \U0001f41f", "new\nline", "x" * 200):
            with self.subTest(name):
                self.write("tiny.yaml", TINY.replace("frames: 20", "frames: 2"))
                self.succeed("generate", "tiny.yaml", f"--out=./{name}", "--progress", "none")
                self.succeed("verify", f"./{name}")


class Limits(FaultTest):
    def test_arguments_beyond_all_bounds(self):
        self.write("tiny.yaml", TINY)
        base = ("generate", "tiny.yaml", "--out", "out")
        for option, values in {"--jobs": (0, -1, 10**9, 10**30, ""), "--pairs": (0, 10**12, 10**40, 1.5),
                               "--seed": (-1, 2**53 + 10**15, 2**64), "--only": (-1, 10**12, 23),
                               "--shard": ("-1/2", "2/2", "0/0", "1/1000000000000", "0/2/3", "")}.items():
            for value in values:
                with self.subTest(f"{option} {value}"):
                    code, _, err = self.run_limited(*base, f"{option}={value}")
                    self.assertEqual(code, 2, err)
                    self.assertIn(option, err)
        ping = ("ping", "block.yaml", "--sonar", "small_sonar.yaml", "--pose", "0 0 -1 0 0 0", "--out", "out")
        for option, values in {"--range-bins": (0, 16385, 10**12), "--range-max": (0, "1e999", "nan"), "--layout": (2**64,),
                               "--seed": (2**63,)}.items():
            for value in values:
                with self.subTest(f"{option} {value}"):
                    self.assertEqual(self.run_limited(*ping, f"{option}={value}")[0], 2)
        for resolution in ("1e-300", "1e-4", "nan", "1e999"):
            self.assertEqual(self.run_limited("voxelize", "block.yaml", "--resolution", resolution, "--out", "o.npz")[0], 2)
        self.assertFalse((self.folder / "out").exists())

    def test_sonars_beyond_all_memory_are_refused_with_a_rule(self):
        rays = "rays: {azimuth_per_beam: 1, elevation: 48}"
        for changes, rule in (
                ([(rays, "rays: {azimuth_per_beam: 64, elevation: 8192}"), ("count: 48", "count: 4096")], "million rays"),
                ([(rays, "rays: {azimuth_per_beam: 64, elevation: 8192}"), ("count: 48", "count: 512")], "million rays"),
                ([(rays, "rays: {azimuth_per_beam: 65, elevation: 48}")], "whole number in [0, 64]"),
                ([(rays, "rays: {azimuth_per_beam: 1, elevation: 1000000}")], "whole number in [0, 8192]"),
                ([("count: 48", "count: 4096"), ("native_bin_m: 0.01", "native_bin_m: 0.0015")], "pixels"),
                ([("native_bin_m: 0.01", "native_bin_m: 0.0001")], "bins")):
            with self.subTest(rule):
                text = SONAR
                for old, new in changes:
                    assert old in text
                    text = text.replace(old, new)
                self.write("bad.yaml", text)
                self.complain([2], ["sonar" if "rays" in rule else "bad.yaml", rule], *COMMANDS["sonar"])

    def test_the_largest_ping_keeps_to_its_memory(self):
        self.write("large.yaml", SONAR.replace("count: 48", "count: 1024").replace("native_bin_m: 0.01", "native_bin_m: 0.0025"))
        self.most_memory = 3 << 30
        self.seconds = 60
        code, said = self.measured("ping", "block.yaml", "--sonar", "large.yaml", "--pose", "-3 0 -2 0 10 0", "--out", "out")
        self.assertEqual(code, 0, said)

    def test_scenes_beyond_all_memory_are_refused(self):
        for old, new in (("grid_resolution_m: 0.2", "grid_resolution_m: 0.001"), ("max: [6, 6, 0]", "max: [6e5, 6e5, 0]"),
                         ("width_m: 1", "width_m: 1\n    count: 1000000"), ("max: [6, 6, 0]", "max: [1e300, 6, 0]"),
                         ("shape: flat", "shape: fractal, rms_m: 0.1, wavelength_m: 1, spacing_m: 0.001")):
            self.write("bad.yaml", SCENE.replace(old, new))
            self.complain([2], ["bad.yaml:"], *COMMANDS["scene"])


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""The command line as a contract: help, exit codes, and errors that name what, where, the rule and the cure."""

import json
import pathlib
import re
import shlex
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from mesh_files import TRIANGLE_DAE
from support import ProgramTest, RECIPE, SCENE, SONAR, changed, files, leftovers, main, manifest, read_grey

COMMANDS = ["", "evaluate", "evaluate filters", "evaluate map", "explore", "filter", "generate", "map", "ping", "reproduce", "scene",
            "scene list", "scene check", "scene show", "scene export", "sonar", "sonar list", "sonar check", "sonar show",
            "stats", "verify", "voxelize"]

class Help(ProgramTest):
    def help_of(self, command):
        return self.succeed(*command.split(), "--help").stdout

    def test_every_command_is_tested_here(self):
        found = set()
        for command in COMMANDS:
            _, _, listed = self.help_of(command).partition("Subcommands:\n")
            found |= {f"{command} {m}".strip() for m in re.findall(r"^  (\w+) ", listed.partition("\n\n")[0], re.M)}
        self.assertEqual(found, set(COMMANDS) - {""})

    def test_every_help_has_an_example_that_parses(self):
        self.write("glider.dae", TRIANGLE_DAE)
        for command in COMMANDS:
            with self.subTest(command):
                _, found, footer = self.help_of(command).partition("Example:\n")
                self.assertTrue(found, f"{command} --help has no example")
                lines = [line.strip() for line in footer.splitlines() if line.startswith("  ensonify ")]
                self.assertTrue(lines)
                for line in lines:
                    self.assertTrue(line.startswith(f"ensonify {command}".strip()), line)
                    words = shlex.split(line)[1:]
                    # An unknown option after the example's words is the only thing wrong: the parser took the others.
                    done = self.run_program(*words, "--no-such-option")
                    self.assertEqual(done.returncode, 2)
                    self.assertIn("The following argument was not expected: --no-such-option", done.stderr, line)

    def test_version_goes_to_standard_output(self):
        self.assertRegex(self.succeed("--version").stdout, r"^ensonify \d+\.\d+\.\d+\n$")


class Usage(ProgramTest):
    def test_wrong_usage_ends_with_2(self):
        self.recipe()
        table = [
            ([], ["subcommand is required"]),
            (["generat"], ["no command 'generat'", "did you mean 'generate'"]),
            (["scene", "chek", "test_tank"], ["no command 'chek'", "did you mean 'check'"]),
            (["fly"], ["no command 'fly'"]),
            (["generate"], ["RECIPE"]),
            (["generate", "small.yaml"], ["--out"]),
            (["generate", "small.yaml", "--out", "o", "--jobs", "0"], ["--jobs"]),
            (["generate", "small.yaml", "--out", "o", "--seed", "-1"], ["--seed"]),
            (["generate", "small.yaml", "--out", "o", "--pairs", "many"], ["--pairs"]),
            (["generate", "small.yaml", "--out", "o", "--format", "zip"], ["--format", "folder", "webdataset"]),
            (["generate", "small.yaml", "--out", "o", "--isa", "mmx"], ["--isa", "avx2"]),
            (["generate", "small.yaml", "--out", "o", "--shard", "4/4"], ["--shard 4/4", "K from 0 to N - 1"]),
            (["generate", "small.yaml", "--out", "o", "--shard", "1"], ["--shard 1", "K/N"]),
            (["generate", "small.yaml", "--out", "o", "--shard", "0/2x"], ["--shard 0/2x"]),
            (["generate", "small.yaml", "--out", "o", "--only", "90"], ["--only 90", "0 to 89"]),
            (["generate", "papier", "--out", "o"], ["papier", "did you mean 'paper'"]),
            (["generate", "missing.yaml", "--out", "o"], ["missing.yaml: no such file"]),
            (["ping", "test_tnk", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 0", "--out", "o"],
             ["did you mean 'test_tank'"]),
            (["ping", "test_tank", "--sonar", "holocean", "--pose", "0 0 -1 0 0 0", "--out", "o"],
             ["did you mean 'holoocean'"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1", "--out", "o"],
             ["--pose", "six numbers", "x y z roll pitch yaw"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 nan", "--out", "o"], ["--pose"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "1e30 0 -1 0 0 0", "--out", "o"],
             ["--pose", "none beyond"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 0", "--seed", "-1", "--out", "o"],
             ["--seed"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 0", "--layout", "-1", "--out", "o"],
             ["--layout"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 0", "--range-max", "nan", "--out", "o"],
             ["--range-max"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--pose", "0 0 -1 0 0 0", "--out", ""], ["--out"]),
            (["generate", "small.yaml", "--out", ""], ["--out"]),
            (["voxelize", "test_tank", "--resolution", "inf", "--out", "o.npz"], ["--resolution"]),
            (["ping", "test_tank", "--sonar", "holoocean", "--noise", "papr", "--pose", "0 0 -1 0 0 0", "--out", "o"],
             ["did you mean 'paper'"]),
            (["ping", "test_tank", "--sonar", "oculus_m1200d_hf", "--range-max", "50", "--pose", "0 0 -1 0 0 0",
              "--out", "o"], ["--range-max 50", "50 m", "0.1 to 10 m"]),
            (["voxelize", "test_tank", "--resolution", "0", "--out", "o.npz"], ["--resolution"]),
            (["voxelize", "test_tank", "--resolution", "0.5", "--out", "o.xyz"], [".xyz", ".npz"]),
            (["voxelize", "test_tank", "--resolution", "0.001", "--out", "o.npz"], ["cells", "m fits"]),
        ]
        for words, fragments in table:
            with self.subTest(words):
                self.refuse(2, fragments, *words)
        self.assertFalse((self.folder / "o").exists(), "wrong usage wrote something")

    def test_failed_work_ends_with_1(self):
        self.write("empty.obj", "")
        self.refuse(1, ["nowhere", "no dataset.json"], "verify", "nowhere")
        self.refuse(1, ["empty.obj: is empty"], "scene", "check", "empty.obj")
        self.refuse(1, ["gone.stl: no such file"], "voxelize", "gone.stl", "--resolution", "0.1", "--out", "o.npz")


class Configuration(ProgramTest):
    """One change to a good file each; the error names file, line, rule and, where there is one, the nearest key."""

    def line_of(self, text, fragment):
        return next(i for i, line in enumerate(text.splitlines(), 1) if fragment in line)

    def check_table(self, good, table, name, *words):
        self.write(name, good)
        self.succeed(*words)
        for old, new, fragments in table:
            with self.subTest(new):
                bad = changed(good, old, new)
                self.write(name, bad)
                line = self.line_of(bad, new.strip().splitlines()[0])
                done = self.refuse(2, fragments, *words)
                self.assertRegex(done.stderr, rf"{re.escape(name)}:\d+: ")
                where = int(re.search(rf"{re.escape(name)}:(\d+): ", done.stderr)[1])
                # A fault of a mapping as a whole is reported where the mapping begins; one of syntax, where it shows.
                self.assertLessEqual(where, line + 2)
                self.assertGreaterEqual(where, line - 6)

    def test_sonars(self):
        self.check_table(SONAR, [
            ("max_m: 20", "range_max_cm: 2000", ["range", "max_m"]),
            ("max_m: 20", "max_cm: 20", ["max_cm", "did you mean 'max_m'"]),
            ("max_m: 20", 'max_m: "5 m"', ["max_m", "must be a plain number", "5 m"]),
            ("max_m: 20", "max_m: 1e9", ["max_m", "must lie in"]),
            ("max_m: 20", "max_m: .nan", ["max_m", "not .nan"]),
            ("min_m: 0.2", "min_m: -1", ["min_m", "must lie in [0"]),
            ("frequency_hz: 1.2e6", "frequency_khz: 1200", ["frequency_hz"]),
            ("frequency_hz: 1.2e6", "frequency_hz: 1.2", ["frequency_hz", "must lie in [10000"]),
            ("count: 48", "count: 0", ["beams.count", "must give 2 to 4096 beams, not 0"]),
            ("count: 48", "count: 1", ["beams.count", "must give 2 to 4096 beams, not 1"]),
            ("count: 48", "count: 4.5", ["beams.count", "whole number"]),
            ("spacing: uniform_sine, count: 48, azimuth_fov_deg: 90", "spacing: listed, azimuth_deg: []",
             ["azimuth_deg", "must give 2 to 4096 beams, not 0"]),
            ("spacing: uniform_sine, count: 48, azimuth_fov_deg: 90", "spacing: listed, azimuth_deg: [1, 3, 2]",
             ["azimuth_deg", "strictly"]),
            ("azimuth_shading: hann", "azimuth_shading: hanning", ["must be one of", "hann", "hanning"]),
            ("azimuth_width_deg: 2", "azimuth_width_rad: 0.03", ["did you mean 'azimuth_width_deg'"]),
            ("gamma: 0.5", "gamma: 0.5\n  gama: 1", ["gama", "did you mean 'gamma'"]),
            ("gamma: 0.5", "gamma: 0.5\n  gamma: 1", ["gamma", "given twice"]),
            ("gamma: 0.5", "gamma: [0.5]", ["gamma", "plain number"]),
            ("title: small test sonar", "title: [", ["no valid YAML"]),
        ], "own_sonar.yaml", "sonar", "check", "own_sonar.yaml")

    def test_scenes(self):
        self.check_table(SCENE, [
            ("grid_resolution_m: 0.2", "grid_resolution_cm: 20", ["did you mean 'grid_resolution_m'"]),
            ("grid_resolution_m: 0.2", "grid_resolution_m: 0.001", ["grid cells"]),
            ("depth_m: 4", "depth_m: -4", ["seabed.depth_m"]),
            ("material: concrete", "material: concret", ["no material 'concret'", "did you mean 'concrete'"]),
            ("shape: box", "shape: bocks", ["must be one of", "box"]),
            ("shape: box", "mesh: gone.obj", ["gone.obj: no such file"]),
            ("width_m: 1", "width_m: 0", ["width_m", "objects[0]"]),
            ("[5, 5, -0.6]", "[5, 5, 0.6]", ["navigable", "inside bounds"]),
            ("[4, -4, -2, 0, 10, 135]", "[4, -4, -9, 0, 10, 135]", ["waypoints", "entry 1", "outside navigable"]),
            ("[4, -4, -2, 0, 10, 135]", "[4, -4, -2]", ["waypoints", "entry 1", "[x, y, z, roll, pitch, yaw]"]),
        ], "own_scene.yaml", "scene", "check", "own_scene.yaml")

    def test_recipes(self):
        good = RECIPE.format(train=3, test=2, range_max_m="8")
        self.check_table(good, [
            ("noise: paper", "nois: paper", ["did you mean 'noise'"]),
            ("frames: 3", "frames: 0", ["splits.train.frames"]),
            ("frames: 3", "frames: three", ["splits.train.frames", "plain number", "three"]),
            ("range_max_m: 8", "range_max_cm: 800", ["sonar.range_max_cm", "did you mean 'range_max_m'"]),
            ("range_max_m: 8", 'range_max_m: "5 m"', ["sonar.range_max_m", "plain number", "5 m"]),
            ("{uniform: [-3, 3]}", "{uniform: [3, -3]}", ["uniform", "must not exceed"]),
            ("{uniform: [-3, 3]}", "{uniforn: [-3, 3]}", ["uniforn", "did you mean 'uniform'"]),
            ("{uniform: [-3, 3]}", "{normal: [0, 50]}", ["3 sigma"]),
            ("layouts: [2]", "layouts: [1]", ["used twice", "must not share a layout"]),
            ("layouts: [2]", "layouts: [1.5]", ["whole numbers"]),
            ("frames: 2", "frames_per_place: 2000000000", ["frames_per_place", "whole number in"]),
            ("rate_hz: 2", "rate_hz: 0", ["rate_hz", "must lie in"]),
            ("  train:", "  tran:", ["tran", "did you mean 'train'"]),
        ], "own.yaml", "generate", "own.yaml", "--out", "own", "--force", "--progress", "none")

    def test_a_configuration_that_is_no_text_or_too_large_is_refused(self):
        self.write("binary.yaml", bytes(range(256)) * 8)
        self.write("large.yaml", "a: 1\n" * 2_000_000)
        self.write("list.yaml", "- 1\n- 2\n")
        self.write("bomb.yaml", "a: &a [x,x,x,x,x,x,x,x]\n" +
                   "".join(f"{b}: &{b} [{','.join(['*' + a] * 8)}]\n" for a, b in zip("abcdefgh", "bcdefghi")))
        for name, fragments in {"binary.yaml": [], "large.yaml": ["4 MiB"], "list.yaml": ["must be a mapping"],
                                "bomb.yaml": []}.items():
            with self.subTest(name):
                for command in ("sonar", "scene"):
                    self.refuse(2, [name, *fragments], command, "check", name)

    def test_a_trajectory_inside_a_wall_is_found_before_any_work(self):
        scene = changed(SCENE, "x_m: {uniform: [-1, 1]}", "x_m: 0")
        self.write("block.yaml", changed(scene, "[4, -4, -2, 0, 10, 135]", "[0, 0, -3, 0, 10, 135]"))
        self.recipe("wall.yaml", train=4, test=40)
        self.refuse(2, ["block", "trajectory runs into something", "move its waypoints"], "generate", "wall.yaml", "--out",
                    "wall")
        self.assertFalse((self.folder / "wall/train").exists())
        self.refuse(2, ["waypoint 1 lies inside something"], "scene", "check", "block.yaml")

    def test_a_place_without_room_fails_and_says_what_to_change(self):
        self.write("block.yaml", SCENE + "  - [0, -4, -2, 0, 0, 90]\n")
        self.recipe("tight.yaml", train=4, test=2)
        recipe = (self.folder / "tight.yaml").read_text()
        self.write("tight.yaml", changed(recipe, "least_seen_share: 0.05", "least_seen_share: 1, tries: 3"))
        self.refuse(1, ["blocks could not be made", "least_seen_share"], "generate", "tight.yaml", "--out", "tight",
                    "--progress", "none")
        self.assertFalse((self.folder / "tight/dataset.json").exists())
        self.assertTrue((self.folder / "tight/.ensonify/failed.jsonl").is_file())


class Output(ProgramTest):
    def setUp(self):
        super().setUp()
        self.recipe(train=4, test=2)
        self.write("a_file", "mine\n")

    def ping(self, out):
        return ("ping", "block.yaml", "--sonar", "small_sonar.yaml", "--pose", "-4 0 -2 0 10 0", "--out", out)

    def test_an_out_that_can_not_be_written_is_refused(self):
        for out in ("a_file/below", "/proc/below", "/dev/null/below"):
            with self.subTest(out):
                self.refuse(1, [out], "generate", "small.yaml", "--out", out)
                self.refuse(1, [out], *self.ping(out))
                self.refuse(1, [out], "voxelize", "block.yaml", "--resolution", "0.5", "--out", f"{out}/grid.npz")
        self.assertEqual((self.folder / "a_file").read_text(), "mine\n")

    def test_an_out_that_holds_other_files_is_left_alone(self):
        (self.folder / "mine").mkdir()
        self.write("mine/thesis.tex", "years of work\n")
        for force in ([], ["--force"]):
            self.refuse(2, ["mine", "holds other files", "new or empty folder"], "generate", "small.yaml", "--out", "mine",
                        *force)
        self.refuse(2, ["a_file", "is a file"], "generate", "small.yaml", "--out", "a_file")
        self.assertEqual(list(files(self.folder / "mine")), ["thesis.tex"])

    def test_force_removes_only_what_a_dataset_consists_of(self):
        self.generate("out")
        self.write("out/notes.txt", "mine\n")
        self.generate("out", "--seed", 3, "--force")
        self.assertEqual((self.folder / "out/notes.txt").read_text(), "mine\n")

    def test_a_full_disk_fails_and_leaves_nothing_complete(self):
        # /dev/full would need a file of its own name; a file size limit is the same to the program.
        import resource
        import subprocess
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        done = subprocess.run([str(self.program), "generate", "small.yaml", "--out", "full"], cwd=self.folder,
                              preexec_fn=limit, restore_signals=False, capture_output=True, text=True, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        self.assertFalse((self.folder / "full/dataset.json").exists())

    def test_ping_writes_what_it_says_and_the_same_again(self):
        self.succeed(*self.ping("a"))
        self.succeed(*self.ping("b"))
        names = ["clean.png", "echo.exr", "fan.png", "labels.png", "mask.png", "ping.json", "raw.png", "truth.exr"]
        self.assertEqual(sorted(files(self.folder / "a")), names)
        self.assertEqual(files(self.folder / "a"), files(self.folder / "b"))
        record = json.loads((self.folder / "a/ping.json").read_text())
        self.assertEqual(record["T_world_sonar"][0][3], -4)
        self.assertEqual(leftovers(self.folder), [])

    def test_ping_keeps_the_bits_of_the_receiver(self):
        self.write("fine.yaml", SONAR.replace("gamma: 0.5", "gamma: 0.5\n  bits: 16"))
        pose = ("--pose", "-4 -4 -2 0 10 45")
        self.succeed("ping", "block.yaml", "--sonar", "fine.yaml", *pose, "--out", "fine")
        self.succeed("ping", "block.yaml", "--sonar", "small_sonar.yaml", *pose, "--out", "coarse")
        fine, coarse = (read_grey(self.folder / name / "raw.png").astype(float) for name in ("fine", "coarse"))
        self.assertEqual(json.loads((self.folder / "fine/ping.json").read_text())["sonar"]["receive"]["bits"], 16)
        self.assertGreater(fine.max(), 255)
        self.assertLessEqual(abs(fine / 257 - coarse).max(), 0.5 + 1e-9)
        self.assertEqual(read_grey(self.folder / "fine/clean.png").dtype.itemsize, 1)

    def test_progress_for_machines_is_a_json_object_a_line(self):
        done = self.succeed("generate", "small.yaml", "--out", "out", "--progress", "json")
        lines = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertEqual(lines[-1]["done"], lines[-1]["total"])
        for line in lines:
            self.assertEqual(set(line), {"stage", "done", "total", "rate_hz", "eta_s"})
            if line["done"] < line["total"]:
                self.assertNotEqual(line["eta_s"], 0, "unknown is null")

    def test_pairs_sets_the_training_frames(self):
        out = self.generate("out", "--pairs", 7)
        self.assertEqual(manifest(out)["counts"], {"train": 7, "test": 2})


if __name__ == "__main__":
    main()

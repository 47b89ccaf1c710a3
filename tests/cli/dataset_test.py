#!/usr/bin/python3
"""A dataset is the same bits by any road: threads, shards, format, after kill and resume. See CONTRIBUTING.md."""

import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tarfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from support import RECIPE, ProgramTest, files, leftovers, main, manifest

# What tells of the run, not of the data.
COMMAND_LINE = "command_line"


def without_command(text):
    content = json.loads(text)
    content.pop(COMMAND_LINE)
    return content


class SameBits(ProgramTest):
    def setUp(self):
        super().setUp()
        self.recipe()

    def assert_same_data(self, a, b):
        self.assertEqual(manifest(a)["root_hash"], manifest(b)["root_hash"])
        told = {"README.md", "dataset.json"}  # both name the command
        self.assertEqual(files(a, told), files(b, told))
        self.assertEqual(without_command((a / "dataset.json").read_text()),
                         without_command((b / "dataset.json").read_text()))

    def test_any_number_of_threads_gives_the_same_files(self):
        one = self.generate("one", "--jobs", 1)
        for jobs in (2, 8):
            self.assert_same_data(one, self.generate(f"jobs{jobs}", "--jobs", jobs))

    def test_four_shards_give_the_files_of_one_process_in_any_order(self):
        one = self.generate("one")
        for shard in (2, 0, 3):
            done = self.succeed("generate", "small.yaml", "--out", "four", "--shard", f"{shard}/4", "--progress", "none")
            self.assertIn(f"shard {shard}/4 done", done.stdout)
            self.assertFalse((self.folder / "four/dataset.json").exists(), "complete before its last shard")
        self.assert_same_data(one, self.generate("four", "--shard", "1/4"))

    def test_four_shards_at_once_give_the_files_of_one_process(self):
        one = self.generate("one")
        shards = [self.start_program("generate", "small.yaml", "--out", "four", "--shard", f"{k}/4", "--jobs", 1,
                                     "--progress", "none") for k in range(4)]
        for shard in shards:
            out, err = shard.communicate(timeout=120)
            self.assertEqual(shard.returncode, 0, out + err)
        self.assert_same_data(one, self.folder / "four")
        self.succeed("verify", "four")

    def test_folder_and_webdataset_hold_the_same_data(self):
        folder = self.generate("folder")
        shards = self.generate("shards", "--format", "webdataset")
        self.assertEqual(manifest(folder)["root_hash"], manifest(shards)["root_hash"])
        self.succeed("verify", "shards")
        tars = sorted((shards / "train").glob("*.tar"))
        with tarfile.open(tars[0]) as tar:
            names = tar.getnames()
        self.assertEqual(names[:5], ["000000.raw.png", "000000.clean.png", "000000.mask.png", "000000.labels.png",
                                     "000000.json"])
        with tarfile.open(tars[0]) as tar:
            inside = tar.extractfile("000003.raw.png").read()
        self.assertEqual(inside, (folder / "train/raw/000003.png").read_bytes())

    def test_only_makes_the_very_files_of_one_frame(self):
        whole = self.generate("whole")
        lines = (whole / "test/metadata.jsonl").read_text().splitlines()
        done = self.succeed("generate", "small.yaml", "--out", "alone", "--only", 83)
        self.assertEqual(done.stdout.strip(), lines[3])
        alone = {p: h for p, h in files(self.folder / "alone").items() if not p.startswith(".ensonify")}
        self.assertEqual(sorted(alone), [f"test/{k}/000003.png" for k in ("clean", "labels", "mask", "raw")])
        made = files(whole)
        self.assertEqual(alone, {p: made[p] for p in alone})

    def test_another_seed_is_another_dataset(self):
        hashes = {manifest(self.generate(f"seed{s}", "--seed", s))["root_hash"] for s in (5, 6, 7)}
        self.assertEqual(len(hashes), 3)
        self.assertEqual(manifest(self.folder / "seed5")["root_hash"], manifest(self.generate("recipe_seed"))["root_hash"])

    def test_a_range_drawn_per_frame_is_the_same_by_any_road(self):
        self.recipe("varied.yaml", train=20, test=4, range_max_m="{uniform: [4, 8]}")
        one = self.generate("one", "--jobs", 1, recipe="varied.yaml")
        self.assert_same_data(one, self.generate("many", "--jobs", 4, recipe="varied.yaml"))
        ranges = {json.loads(line)["range_max_m"] for line in (one / "train/metadata.jsonl").read_text().splitlines()}
        self.assertEqual(len(ranges), 20)
        self.succeed("verify", "one")

    def test_the_card_says_what_range_is_drawn(self):
        for name, given, said in (("drawn", "{uniform: [4, 8]}", "128 range bins (rows, nearest first, from 0.2 m to an end "
                                   "that is drawn, 4 to 8 m)"),
                                  ("fixed", "8", "128 range bins (rows, nearest first, 0.2 to 8 m)")):
            self.recipe(f"{name}.yaml", train=2, test=2, range_max_m=given)
            self.assertIn(said, (self.generate(name, recipe=f"{name}.yaml") / "README.md").read_text())
        native = self.recipe("native.yaml", train=2, test=2, range_max_m="{uniform: [4, 8]}")
        native.write_text(native.read_text().replace("range_bins: 128", "range_bins: native"))
        self.assertIn("Images are 380 to 780 range bins", (self.generate("native", recipe="native.yaml") / "README.md").read_text())

    def test_what_is_refused_leaves_the_folder_to_what_is_corrected(self):
        good = self.write("mine.yaml", RECIPE.format(train=4, test=4, range_max_m="8")).read_text()
        scene = (self.folder / "block.yaml").read_text()
        for file, broken, fragment in (
                ("mine.yaml", good.replace("speed_mps: 0.5", "orbit: {object: block, radius_m: 0.4, depth_m: 3}"), "runs into"),
                ("mine.yaml", good.replace("speed_mps: 0.5", "orbit: {object: blok, radius_m: 2, depth_m: 3}"), "blok"),
                ("block.yaml", scene.replace("length_m: {uniform: [1, 2]}", "length_m: 0"), "length_m"),
                ("block.yaml", scene.replace("shape: box", "mesh: gone.obj"), "gone.obj")):
            with self.subTest(fragment):
                whole = (self.folder / file).read_text()
                self.write(file, broken)
                done = self.run_program("generate", "mine.yaml", "--out", "mine")
                self.assertIn(done.returncode, (1, 2))
                self.assertIn(fragment, done.stderr)
                self.assertFalse((self.folder / "mine").exists())
                self.run_program("generate", "mine.yaml", "--out", "mine", "--only", 5)
                self.assertFalse((self.folder / "mine").exists())
                self.write(file, whole)
        self.generate("mine", recipe="mine.yaml")

    def test_splits_share_no_frame(self):
        whole = self.generate("whole")
        raw = [h for p, h in files(whole).items() if "/raw/" in p]
        self.assertEqual(len(raw), 90)
        self.assertEqual(len(set(raw)), 90)


class Interrupted(ProgramTest):
    frames = 700

    def setUp(self):
        super().setUp()
        self.recipe(train=self.frames, test=10)

    def stop_in_the_middle(self, out, with_signal, after, *words):
        process = self.start_program("generate", "small.yaml", "--out", out, "--progress", "none", *words)
        self.addCleanup(process.kill)
        target = self.folder / out / after
        deadline = time.monotonic() + 60
        while not target.exists():
            self.assertIsNone(process.poll(), "ended before it could be stopped")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.002)
        process.send_signal(with_signal)
        _, said = process.communicate(timeout=60)
        return process.returncode, said

    def check_stopped(self, with_signal, code):
        status, said = self.stop_in_the_middle("out", with_signal, "train/raw/000040.png", "--jobs", 2)
        self.assertEqual(status, code)
        self.assertIn("the same command resumes", said)
        out = self.folder / "out"
        self.assertFalse((out / "dataset.json").exists())
        self.assertFalse((out / "train/metadata.jsonl").exists())
        self.assertEqual(leftovers(out), [])
        self.refuse(1, ["no dataset.json", "run generate again"], "verify", "out")
        self.generate("out")
        self.succeed("verify", "out")

    def test_sigint_ends_with_130_leaves_nothing_complete_and_resumes(self):
        self.check_stopped(signal.SIGINT, 130)

    def test_sigterm_ends_with_143_leaves_nothing_complete_and_resumes(self):
        self.check_stopped(signal.SIGTERM, 143)

    def test_killed_any_number_of_times_it_ends_with_the_same_hash(self):
        undisturbed = self.generate("undisturbed")
        for format_name in ("folder", "webdataset"):
            out = self.folder / format_name
            stops = {"folder": ("train/raw/000040.png", "train/raw/000600.png", "grids/block_layout0.npz"),
                     "webdataset": ("train/train-000000.tar", "grids/block_layout0.npz")}[format_name]
            for after in stops:
                status, _ = self.stop_in_the_middle(format_name, signal.SIGKILL, after, "--format", format_name)
                self.assertEqual(status, -signal.SIGKILL)
                self.assertFalse((out / "dataset.json").exists())
            self.generate(format_name, "--format", format_name)
            self.succeed("verify", format_name)
            self.assertEqual(leftovers(out), [], "what the killed processes left is still there")
            self.assertEqual(manifest(out)["root_hash"], manifest(undisturbed)["root_hash"])


class Again(ProgramTest):
    def setUp(self):
        super().setUp()
        self.recipe(train=32, test=4)

    def test_a_complete_set_is_left_alone(self):
        out = self.generate("out")
        told = self.succeed("verify", "out").stdout
        before = {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file() and p.name != "plan.json"}
        self.generate("out")
        after = {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file() and p.name != "plan.json"}
        self.assertEqual(before, after)
        self.assertEqual(self.succeed("verify", "out").stdout, told)

    def test_what_is_gone_of_a_complete_set_is_named_and_made_again(self):
        out = self.generate("out")
        whole = {p: p.read_bytes() for p in out.rglob("*") if p.is_file() and ".ensonify" not in p.parts}
        kept = (out / "train/raw/000020.png").stat().st_ino
        for name, spoil in [("train/raw/000003.png", lambda p: p.unlink()), ("grids/block.bt", lambda p: p.unlink()),
                            ("checksums.txt", lambda p: p.unlink()),
                            ("test/mask/000001.png", lambda p: p.write_bytes(p.read_bytes()[:-1]))]:
            spoil(out / name)
            told = self.succeed("generate", "small.yaml", "--out", "out", "--progress", "none").stderr
            self.assertIn(f"out/{name}: gone or cut short", told)
            self.assertIn("ensonify verify out", told)
            self.assertEqual({p for p, data in whole.items() if p.read_bytes() != data}, set(), name)
            self.succeed("verify", "out")
        self.assertEqual((out / "train/raw/000020.png").stat().st_ino, kept, "a whole block was made again")

    def test_a_set_of_another_seed_is_refused_and_replaced_by_force(self):
        out = self.generate("out")
        first = manifest(out)["root_hash"]
        self.refuse(2, ["out", "another recipe, seed", "--force"], "generate", "small.yaml", "--out", "out", "--seed", 9)
        self.assertEqual(manifest(out)["root_hash"], first)
        self.generate("out", "--seed", 9, "--force")
        self.assertNotEqual(manifest(out)["root_hash"], first)
        self.succeed("verify", "out")

    def test_force_takes_nothing_from_a_set_of_the_same_plan(self):
        out = self.generate("out")
        image = out / "train/raw/000000.png"
        made = image.stat().st_ino
        self.generate("out", "--force")  # shards that are all started with --force must not undo each other
        self.assertEqual(image.stat().st_ino, made)
        self.refuse(2, ["another recipe, seed"], "generate", "small.yaml", "--out", "out", "--seed", 9, 
                    "--only", 0, "--force")
        self.assertEqual(image.stat().st_ino, made)

    def test_a_stopped_replacement_does_not_look_complete(self):
        self.recipe(train=700)
        self.recipe("few.yaml", train=32, test=4)
        out = self.generate("out", recipe="few.yaml")
        process = self.start_program("generate", "small.yaml", "--out", "out", "--force", "--progress", "none")
        while not (out / "train/raw/000100.png").exists():
            time.sleep(0.002)
        process.kill()
        process.communicate(timeout=60)
        self.assertFalse((out / "dataset.json").exists())


class Verified(ProgramTest):
    """verify finds whatever was changed after the fact."""

    def setUp(self):
        super().setUp()
        self.recipe(train=20, test=4)
        self.out = self.generate("out")
        self.succeed("verify", "out")

    def check_found(self, change, fragments):
        copy = self.folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.out, copy)
        change(copy)
        self.refuse(1, fragments, "verify", "copy")

    def test_it_finds_what_is_missing_swapped_cut_or_changed(self):
        def swap(copy, kind="raw"):
            a, b = copy / f"train/{kind}/000001.png", copy / f"train/{kind}/000002.png"
            data = a.read_bytes()
            a.write_bytes(b.read_bytes())
            b.write_bytes(data)

        def cut(path):
            return lambda copy: (copy / path).write_bytes((copy / path).read_bytes()[:-40])

        def edit(path, old, new):
            def change(copy):
                text = (copy / path).read_text()
                self.assertIn(old, text)
                (copy / path).write_text(text.replace(old, new, 1))
            return change

        table = {
            "missing image": (lambda c: (c / "train/mask/000003.png").unlink(), ["000003.png"]),
            "swapped raw": (swap, ["differ from the manifest", "raw/000001.png", "raw/000002.png"]),
            "swapped masks": (lambda c: swap(c, "mask"), ["mask is not clean >="]),
            "cut image": (cut("test/clean/000001.png"), ["000001.png"]),
            "changed metadata": (edit("train/metadata.jsonl", '"noise":"paper"', '"noise":"none"'), ["differ"]),
            "missing metadata line": (lambda c: (c / "test/metadata.jsonl").write_text(""), ["test"]),
            "cut grid": (cut("grids/block_layout0.npz"), ["block_layout0.npz"]),
            "missing map": (lambda c: (c / "grids/block_layout0.bt").unlink(), ["block_layout0.bt"]),
            "broken manifest": (cut("dataset.json"), ["dataset.json", "no whole JSON"]),
            "another root hash": (edit("dataset.json", '"root_hash": "', '"root_hash": "0'), ["root"]),
        }
        for name, (change, fragments) in table.items():
            with self.subTest(name):
                self.check_found(change, fragments)


if __name__ == "__main__":
    main()

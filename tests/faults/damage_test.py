#!/usr/bin/python3
"""A finished dataset that was damaged: verify names the file, whatever it is and whatever was done to it; and a manifest
written to hurt neither stops it nor makes it look elsewhere."""

import json
import os
import pathlib
import shutil
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from faults import TINY, FaultTest  # noqa: E402
from support import main, manifest  # noqa: E402


SMALL = TINY.replace("frames: 20", "frames: 2").replace("frames: 3", "frames: 2")


def flip(path, at=0.5):
    data = bytearray(path.read_bytes())
    data[min(int(at * len(data)), len(data) - 1)] ^= 4
    path.write_bytes(bytes(data))


def covered(folder):
    """The files that verify answers for: all but its own notes."""
    return sorted(p for p in folder.rglob("*") if p.is_file() and ".ensonify" not in p.parts)


class Damaged(FaultTest):
    """One folder with EXR truth, one of tar shards."""

    sets = {}

    @classmethod
    def tearDownClass(cls):
        if cls.sets:
            shutil.rmtree(next(iter(cls.sets.values())).parent)

    def dataset(self, form):
        if form not in self.sets:
            truth = "truth: true\n" if form == "folder" else ""
            self.write("tiny.yaml", SMALL.replace("splits:", truth + "splits:"))
            made = self.generate(form, "--format", form, recipe="tiny.yaml")
            keep = next(iter(self.sets.values())).parent if self.sets else pathlib.Path(self.folder.as_posix() + "_kept")
            shutil.copytree(made, keep / form)
            type(self).sets[form] = keep / form
        copy = self.folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.sets[form], copy)
        return copy

    def names(self, form, change):
        """Applies change(path) to many files at once; verify must name each of them. The manifest, which all rests on,
        is left to tests of its own."""
        copy = self.dataset(form)
        files = [p for p in covered(copy) if p.name not in ("dataset.json", "checksums.txt")]
        if form == "folder":
            self.assertEqual(len(files), 4 * 5 + 2 + 2 + 3 * 4 + 2)
        for path in files:
            change(path)
        _, _, err = self.run_limited("verify", "copy", "--progress", "none")
        for path in files:
            self.assertIn(str(path.relative_to(copy)), err)

    def test_one_bit_of_any_file_is_found_and_the_file_named(self):
        for form in ("folder", "webdataset"):
            for at in (0, 0.5, 1):
                with self.subTest(f"{form} {at}"):
                    self.names(form, lambda path, at=at: flip(path, at))

    def test_a_byte_less_a_byte_more_nothing_or_no_file_is_found_and_the_file_named(self):
        for form in ("folder", "webdataset"):
            for what, change in {"less": lambda p: os.truncate(p, p.stat().st_size - 1),
                                 "more": lambda p: p.open("ab").write(b"x"),
                                 "nothing": lambda p: os.truncate(p, 0),
                                 "no file": lambda p: p.unlink()}.items():
                with self.subTest(f"{form} {what}"):
                    self.names(form, change)

    def test_each_alone_is_the_only_one_named(self):
        copy = self.dataset("folder")
        every = [str(p.relative_to(copy)) for p in covered(copy)]
        for name in ("train/raw/000001.png", "test/truth/000000.exr", "grids/block_layout0.bt", "test/metadata.jsonl",
                     "README.md", "test/trajectories/block_est.txt", "dataset.json", "checksums.txt"):
            with self.subTest(name):
                kept = (copy / name).read_bytes()
                flip(copy / name)
                code, _, err = self.run_limited("verify", "copy", "--progress", "none")
                self.assertEqual(code, 1)
                named = {other for other in every if other in err}
                self.assertEqual(named - {"dataset.json", "checksums.txt"}, {name} - {"dataset.json", "checksums.txt"}, err)
                self.assertIn(name, err)
                (copy / name).write_bytes(kept)
        self.succeed("verify", "copy")

    def test_every_bit_of_the_manifest_counts(self):
        copy = self.dataset("folder")
        whole = (copy / "dataset.json").read_bytes()
        for k in range(12):
            flip(copy / "dataset.json", k / 12 + 0.003)
            self.complain([1], ["dataset.json"], "verify", "copy", "--progress", "none")
            (copy / "dataset.json").write_bytes(whole)

    def test_a_stranger_and_two_that_swapped_are_named(self):
        copy = self.dataset("folder")
        for name in ("train/raw/000002.png", "notes.txt", "grids/.a.npz.tmp-elsewhere-1", "a\nb"):
            (copy / name).write_text("x")
            self.complain([1], [name, "no file of the dataset"], "verify", "copy", "--progress", "none")
            (copy / name).unlink()
        (copy / ".gitattributes").write_text("hidden files at the top are let be")
        self.succeed("verify", "copy")
        for a, b in (("train/raw/000000.png", "train/raw/000001.png"), ("train/truth/000000.exr", "train/truth/000001.exr")):
            (copy / a).rename(copy / "c"), (copy / b).rename(copy / a), (copy / "c").rename(copy / b)
            self.complain([1], [a, b], "verify", "copy", "--progress", "none")
            (copy / a).rename(copy / "c"), (copy / b).rename(copy / a), (copy / "c").rename(copy / b)

    def test_pixels_count_not_how_they_are_packed(self):
        copy = self.dataset("folder")
        path = copy / "train/clean/000000.png"
        data = path.read_bytes()
        length = struct.unpack(">I", data[33:37])[0]
        packed = zlib.compress(zlib.decompress(data[41:41 + length]), 9)
        body = b"IDAT" + packed
        path.write_bytes(data[:33] + struct.pack(">I", len(packed)) + body + struct.pack(">I", zlib.crc32(body)) + data[-12:])
        self.succeed("verify", "copy")

    def test_what_verify_names_is_made_anew(self):
        copy = self.dataset("folder")
        hash_before = manifest(copy)["root_hash"]
        flip(copy / "train/mask/000001.png")
        err = self.complain([1], ["delete the files named and dataset.json"], "verify", "copy", "--progress", "none")
        self.assertIn("train/mask/000001.png", err)
        (copy / "train/mask/000001.png").unlink()
        (copy / "dataset.json").unlink()
        self.write("tiny.yaml", SMALL.replace("splits:", "truth: true\nsplits:"))
        self.generate("copy", recipe="tiny.yaml")
        self.succeed("verify", "copy")
        self.assertEqual(manifest(copy)["root_hash"], hash_before)

    def test_manifests_that_want_to_hurt(self):
        copy = self.dataset("folder")
        secret = self.folder / "secret.npz"
        shutil.copy(copy / "grids/block.npz", secret)
        good = json.loads((copy / "dataset.json").read_text())
        del good["manifest_sha256"]

        def at(path, value):
            changed = json.loads(json.dumps(good))
            *keys, last = path
            inner = changed
            for key in keys:
                inner = inner[key]
            inner[last] = value
            return json.dumps(changed)

        texts = {"deep arrays": "[" * 500_000, "deep objects": '{"a":' * 500_000, "empty": "", "null": "null",
                 "list": "[]", "number": "1e999", "not UTF-8": '{"a": "\xff"}', "zeros": "\0" * 1000, "nothing": "{}",
                 "deep and whole": '{"mask":' + "[" * 100_000 + "]" * 100_000 + "}"}
        for key in good:
            texts[f"without {key}"] = json.dumps({k: v for k, v in good.items() if k != key})
        for key in good:
            for value in (None, [], {"sha256": 1}, -1):
                texts[f"{key} is {value}"] = at([key], value)
        for value in (-1, 10**9, 2**63, 2**64 - 1, 1.5, "2", None, 1e300):
            texts[f"count {value}"] = at(["counts", "train"], value)
            texts[f"frames {value}"] = at(["shards", 0, "frames"], value)
            texts[f"bins {value}"] = at(["sonar", "range_bins"], value)
            texts[f"threshold {value}"] = at(["mask", "threshold"], value)
        for name in ("../../secret.npz", str(secret), "grids/../../secret.npz", "grids", "/dev/zero", "grids/\0.npz"):
            texts[f"grid {name}"] = at(["grids", 0, "file"], name)
        for name in ("..", "../copy/train", "/etc", "train/../train", ""):
            texts[f"split {name}"] = at(["shards", 0, "split"], name)
        harmless = ("tool", "command_line", "noise", "seed", "isa", "labels", "trajectories", "schema", "schema_version")
        self.seconds = 20
        names = [n for n in texts if not n.startswith(tuple(f"{k} is" for k in harmless))]
        names = [n for n in names if not n.removeprefix("without ").startswith(harmless)]
        for name in names:
            with self.subTest(name):
                (copy / "dataset.json").write_bytes(texts[name].encode("utf-8", "surrogateescape")
                                                    if name != "not UTF-8" else b'{"a": "\xff"}')
                code, _, err = self.run_limited("verify", "copy", "--progress", "none")
                if name in ("without checksums", "without recipe") and code == 0:
                    continue
                self.assertEqual(code, 1, err)
                self.assertTrue(err.startswith("ensonify: "), err[:200])
                self.assertNotIn("secret.npz differs", err)

    def test_lists_and_lines_that_want_to_hurt(self):
        copy = self.dataset("folder")
        self.write("secret", "x")
        whole = (copy / "checksums.txt").read_text()
        for line in ("../secret", "/etc/passwd", "train/../../secret", "a//b", "./README.md", "README.md"):
            (copy / "checksums.txt").write_text(whole + "0" * 64 + "  " + line + "\n")
            err = self.complain([1], ["checksums.txt"], "verify", "copy", "--progress", "none")
            self.assertNotIn("passwd differs", err)
        (copy / "checksums.txt").write_text(whole)
        for name in ("train/metadata.jsonl", "checksums.txt", "grids/block_layout0.npz", "train/raw/000000.png",
                     "test/truth/000000.exr"):
            path = copy / name
            kept = path.read_bytes()
            for what in ("pipe", "zero", "folder", "huge"):
                with self.subTest(f"{name} {what}"):
                    path.unlink()
                    if what == "pipe":
                        os.mkfifo(path)
                    elif what == "zero":
                        path.symlink_to("/dev/zero")
                    elif what == "folder":
                        path.mkdir()
                    else:
                        path.touch()
                        os.truncate(path, 50 << 20)  # a hole
                    self.complain([1], [path.name], "verify", "copy", "--progress", "none")
                    path.rmdir() if what == "folder" else path.unlink()
                    path.write_bytes(kept)
        self.succeed("verify", "copy")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""The disk is full, gone, a file or a link to nowhere; the program is stopped; nobody reads: what is left is whole or
says that it is not, and the same command later ends with the same bits."""

import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from faults import PATIENCE, TINY, FaultTest  # noqa: E402
from support import leftovers, main, manifest  # noqa: E402

KIB = 1024
PING = ("ping", "block.yaml", "--sonar", "small_sonar.yaml", "--pose", "-3 0 -2 0 10 0", "--range-bins", "64", "--out")
VOXELS = ("voxelize", "block.yaml", "--resolution", "0.1", "--out")


def on_full_tmpfs():
    """For preexec_fn: the folder `full` of the working folder becomes a disk of 64 KiB, for this process alone."""
    libc = ctypes.CDLL(None, use_errno=True)
    private, new_mounts = 1 << 18 | 1 << 14, 0x20000
    if libc.unshare(new_mounts) or libc.mount(b"none", b"/", None, private, None):
        os._exit(77)
    if libc.mount(b"tmpfs", b"full", b"tmpfs", 0, b"size=64k"):
        os._exit(77)


class FullDisk(FaultTest):
    def test_generate_says_what_it_could_not_write_and_ends_with_the_same_bits_later(self):
        self.write("tiny.yaml", TINY)
        for form in ("folder", "webdataset"):
            whole = self.generate(f"whole_{form}", "--format", form, recipe="tiny.yaml")
            largest = max(p.stat().st_size for p in whole.rglob("*") if p.is_file())
            # The first block, later blocks, the grids, the manifest: whatever does not fit.
            for part in (500, 3000, largest // 2, largest - 1):
                with self.subTest(f"{form} {part}"):
                    out = f"out_{form}_{part}"
                    self.complain([1], [out, "can not be written", "File too large"], "generate", "tiny.yaml", "--out",
                                  out, "--format", form, "--progress", "none", file_bytes=part)
                    self.assertEqual(leftovers(self.folder / out), [])
                    self.assertFalse((self.folder / out / "dataset.json").exists())
                    self.complain([1], [out, "no dataset.json", "run generate again"], "verify", out)
            again = self.generate(f"out_{form}_3000", "--format", form, recipe="tiny.yaml")
            self.assertEqual(manifest(again)["root_hash"], manifest(whole)["root_hash"])
            self.succeed("verify", again.name)

    def test_every_other_writer_says_so_and_leaves_nothing(self):
        for words, bytes_that_fit in (
                ((*PING, "ping"), 200), ((*PING, "ping"), 1500),
                *(((*VOXELS, f"grid{e}"), 100) for e in (".npz", ".bt", ".vdb", ".ply", ".pgm")),
                (("scene", "show", "block.yaml", "--width", "100", "--out", "show"), 500),
                *((("scene", "export", "block.yaml", "--out", f"mesh{e}"), 64) for e in (".glb", ".obj", ".ply", ".stl")),
                (("sonar", "show", "small_sonar.yaml", "--out", "sonar"), 100)):
            with self.subTest(words):
                out = self.folder / words[-1]
                if words[-1].endswith(".vdb") and "without OpenVDB" in self.run_limited(*words)[2]:
                    continue
                if out.is_file():
                    out.unlink()
                self.complain([1], [words[-1], "can not be written", "File too large"], *words, file_bytes=bytes_that_fit)
                self.assertEqual(leftovers(self.folder), [])
                self.assertFalse(out.is_file())

    def test_a_full_file_system(self):
        (self.folder / "full").mkdir()
        process = subprocess.run([str(self.program), *VOXELS, "full/grid.ply"], cwd=self.folder, capture_output=True,
                                 text=True, preexec_fn=on_full_tmpfs, timeout=30 * PATIENCE, env=self.environment())
        if process.returncode == 77:
            self.skipTest("no right to mount a file system here")
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("full/grid.ply: can not be written: No space left on device", process.stderr)

    def test_standard_output_that_takes_nothing_is_no_success(self):
        for words in (("scene", "list"), ("--help",), ("sonar", "check", "small_sonar.yaml"), (*VOXELS, "a.npz")):
            with self.subTest(words):
                with open("/dev/full", "wb") as full:
                    code, _, err = self.run_limited(*words, stdout=full)
                self.assertEqual((code, "standard output" in err), (1, True), err)
                closed = subprocess.run(["/bin/sh", "-c", '"$0" "$@" >&-', self.program, *words], cwd=self.folder,
                                        capture_output=True, text=True, timeout=30 * PATIENCE, env=self.environment())
                self.assertEqual(closed.returncode, 1, closed.stderr)
                self.assertIn("standard output", closed.stderr)
        all_closed = subprocess.run(["/bin/sh", "-c", '"$0" "$@" <&- >&- 2>&-', self.program, *VOXELS, "b.npz"],
                                    cwd=self.folder, timeout=30 * PATIENCE, env=self.environment())
        self.assertEqual(all_closed.returncode, 1)
        self.assertEqual((self.folder / "a.npz").read_bytes(), (self.folder / "b.npz").read_bytes())

    def test_a_reader_that_has_seen_enough_is_no_fault(self):
        for words in ("sonar list", "scene list", "sonar list --markdown", "--help"):
            done = subprocess.run(["/bin/bash", "-c", f'set -o pipefail; "$0" {words} | true', self.program],
                                  cwd=self.folder, capture_output=True, text=True, timeout=30 * PATIENCE, env=self.environment())
            self.assertEqual((done.returncode, done.stderr), (0, ""), words)


class OddPlaces(FaultTest):
    def outputs(self, name):
        """Commands that write to `name`, a folder or a file below it."""
        yield "generate", "tiny.yaml", "--progress", "none", "--out", name
        yield *PING, name
        yield *VOXELS, f"{name}/a.npz"
        yield *VOXELS, f"{name}/a.pgm"
        yield "scene", "show", "block.yaml", "--width", "100", "--out", name
        yield "scene", "export", "block.yaml", "--out", f"{name}/a.glb"
        yield "sonar", "show", "small_sonar.yaml", "--out", name

    def test_folders_that_can_not_be(self):
        self.write("tiny.yaml", TINY)
        self.write("file", "kept")
        (self.folder / "dangling").symlink_to("nowhere/at/all")
        (self.folder / "loop").symlink_to("loop")
        for place in ("file", "file/below", "dangling", "dangling/below", "loop", "/proc/1/nothing", "/sys/nothing",
                      "n" * 300, "/".join(["n" * 200] * 30)):
            every = place in ("file", "dangling", "/proc/1/nothing")
            for words in list(self.outputs(place))[:None if every else 3]:
                with self.subTest(words[0] + " " + words[-1][:40]):
                    self.complain([1, 2], [place[:20]], *words)
        self.assertEqual((self.folder / "file").read_text(), "kept")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["block.yaml", "dangling", "file", "loop", "small_sonar.yaml", "tiny.yaml"])

    def test_a_file_that_is_no_file_is_not_replaced(self):
        (self.folder / "null.npz").symlink_to("/dev/null")
        os.mkfifo(self.folder / "pipe.npz")
        (self.folder / "folder.npz").mkdir()
        for name in ("null.npz", "pipe.npz", "folder.npz"):
            self.complain([1], [name, "no regular file"], *VOXELS, name)
        self.assertTrue((self.folder / "null.npz").is_symlink())

    def test_missing_parents_are_made(self):
        self.succeed(*VOXELS, "a/b/c/grid.npz")

    def test_a_read_only_file_system(self):
        def read_only():
            on_full_tmpfs()
            ctypes.CDLL(None).mount(b"none", b"full", None, 1 | 32, None)  # read-only, remount
        (self.folder / "full").mkdir()
        done = subprocess.run([str(self.program), *PING, "full/ping"], cwd=self.folder, capture_output=True, text=True,
                              preexec_fn=read_only, timeout=30 * PATIENCE, env=self.environment())
        if done.returncode == 77:
            self.skipTest("no right to mount a file system here")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("Read-only file system", done.stderr)


class Stopped(FaultTest):
    seconds = 60

    def wait_for(self, path, process):
        deadline = time.monotonic() + 30 * PATIENCE
        while not path.exists():
            self.assertIsNone(process.poll(), "ended before it could be disturbed")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.001)

    def test_a_folder_that_is_removed_meanwhile(self):
        self.write("long.yaml", TINY.replace("frames: 20", "frames: 4000"))
        for form, sign in (("folder", "out/train/raw/000020.png"), ("webdataset", "out/train/train-000000.tar")):
            process = self.start("generate", "long.yaml", "--out", "out", "--format", form, "--progress", "none")
            self.addCleanup(process.kill)
            self.wait_for(self.folder / sign, process)
            for _ in range(100):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
            _, err = process.communicate(timeout=self.seconds * PATIENCE)
            self.assertEqual(process.returncode, 1, err)
            self.assertIn(b"out", err)
            self.assertFalse((self.folder / "out/dataset.json").exists())
            shutil.rmtree(self.folder / "out", ignore_errors=True)

    def test_files_that_are_removed_meanwhile_are_made_again(self):
        self.write("tiny.yaml", TINY)
        whole = self.generate("whole", recipe="tiny.yaml")
        out = self.folder / "out"
        shutil.copytree(whole, out)
        (out / "dataset.json").unlink()
        (out / "train/mask/000003.png").unlink()
        os.truncate(out / "train/raw/000018.png", 100)
        (out / ".ensonify/blocks/000002.json").write_text('{"frames": [')
        self.generate("out", recipe="tiny.yaml")
        self.succeed("verify", "out")
        self.assertEqual((out / "checksums.txt").read_bytes(), (whole / "checksums.txt").read_bytes())

    def test_a_signal_ends_single_commands_with_its_code_and_no_half_of_a_file(self):
        commands = {"ping": (*PING, "out"), "voxelize": (*VOXELS, "out/g.npz"),
                    "show": ("scene", "show", "block.yaml", "--width", "200", "--out", "out")}
        for name, words in commands.items():
            began = time.monotonic()
            self.succeed(*words)
            whole = time.monotonic() - began
            shutil.rmtree(self.folder / "out")
            for step in range(4):
                sent = (signal.SIGINT, signal.SIGTERM)[step % 2]
                process = self.start(*words)
                time.sleep(whole * (0.7 + 0.1 * step))
                process.send_signal(sent)
                process.communicate(timeout=self.seconds * PATIENCE)
                # The negative one: before the program had begun.
                self.assertIn(process.returncode, (0, 128 + sent, -sent), name)
                self.assertEqual(leftovers(self.folder), [], name)
            shutil.rmtree(self.folder / "out", ignore_errors=True)

    def test_a_signal_between_two_writes_ends_with_its_code(self):
        # A pipe nobody reads from holds the program up in its last act; the signal comes while files are written.
        process = self.start(*PING, "out")
        self.wait_for(self.folder / "out/raw.png", process)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=self.seconds * PATIENCE)
        self.assertIn(process.returncode, (0, 143))
        self.assertEqual(leftovers(self.folder), [])

    def test_what_a_kill_left_goes_at_the_next_run(self):
        dead = subprocess.Popen(["/bin/true"])
        dead.wait()
        mine = f".tmp-{os.uname().nodename}-"
        (self.folder / "out").mkdir()
        for name in (f".raw.png{mine}{dead.pid}", f".g.npz{mine}{dead.pid}"):
            (self.folder / "out" / name).write_text("half")
        kept = self.write(f"out/.g.npz{mine}{os.getpid()}", "of a process that runs")
        self.succeed(*VOXELS, "out/g.npz")
        self.assertEqual(leftovers(self.folder), [kept])


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Several processes in one folder: the same work ends right, other work is refused, and the dead hold nothing up."""

import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from faults import PATIENCE, TINY, FaultTest  # noqa: E402
from support import leftovers, main, manifest  # noqa: E402


class Together(FaultTest):
    seconds = 60

    def setUp(self):
        super().setUp()
        self.write("tiny.yaml", TINY.replace("frames: 20", "frames: 100"))

    def begin(self, *words, out="out"):
        process = self.start("generate", "tiny.yaml", "--out", out, "--jobs", "1", "--progress", "none", *words)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        out, err = process.communicate(timeout=self.seconds * PATIENCE)
        return process.returncode, (out + err).decode()

    def wait_for(self, path):
        deadline = time.monotonic() + 30 * PATIENCE
        while not path.exists():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.001)

    def test_the_same_command_three_times_at_once_makes_the_set(self):
        whole = self.generate("whole", recipe="tiny.yaml")
        for form in ("folder", "webdataset"):
            runs = [self.begin("--format", form, out=form) for _ in range(3)]
            for run in runs:
                code, said = self.end(run)
                self.assertEqual(code, 0, said)
            self.succeed("verify", form)
            self.assertEqual(manifest(self.folder / form)["root_hash"], manifest(whole)["root_hash"])
            self.assertEqual(leftovers(self.folder / form), [])

    def test_of_two_seeds_at_once_one_is_made_and_the_other_refused(self):
        hashes = {manifest(self.generate(f"seed{s}", "--seed", s, recipe="tiny.yaml"))["root_hash"] for s in (1, 2, 3)}
        for attempt in range(3):
            out = f"out{attempt}"
            runs = [self.begin("--seed", str(s), out=out) for s in (1, 2, 3)]
            ends = [self.end(run) for run in runs]
            self.assertEqual(sorted(code for code, _ in ends), [0, 2, 2], ends)
            for code, said in ends:
                if code == 2:
                    self.assertIn("another recipe, seed", said)
            self.succeed("verify", out)
            self.assertIn(manifest(self.folder / out)["root_hash"], hashes)

    def test_force_takes_nothing_from_one_who_works_and_all_from_one_who_is_dead(self):
        self.write("tiny.yaml", TINY.replace("frames: 20", "frames: 3000"))
        first = self.begin("--seed", "1")
        self.wait_for(self.folder / "out/train/raw/000020.png")
        self.complain([2], ["another process works in it"], "generate", "tiny.yaml", "--out", "out", "--seed", "2", "--force",
                      "--progress", "none")
        self.assertIsNone(first.poll())
        first.send_signal(signal.SIGKILL)
        self.end(first)
        self.write("tiny.yaml", TINY)
        self.generate("out", "--seed", "2", "--force", recipe="tiny.yaml")
        self.succeed("verify", "out")
        self.assertEqual(leftovers(self.folder / "out"), [])

    def test_one_of_two_is_killed(self):
        whole = self.generate("whole", recipe="tiny.yaml")
        runs = [self.begin(), self.begin()]
        self.wait_for(self.folder / "out/train/raw/000020.png")
        runs[0].send_signal(signal.SIGKILL)
        self.end(runs[0])
        code, said = self.end(runs[1])
        self.assertEqual(code, 0, said)
        self.succeed("verify", "out")
        self.assertEqual(manifest(self.folder / "out")["root_hash"], manifest(whole)["root_hash"])
        self.assertEqual(leftovers(self.folder / "out"), [])

    def test_shards_that_overlap_and_a_full_disk_for_one(self):
        whole = self.generate("whole", recipe="tiny.yaml")
        runs = [self.begin("--shard", shard) for shard in ("0/3", "1/3", "2/3", "1/2")]
        self.complain([1], ["can not be written"], "generate", "tiny.yaml", "--out", "out", "--shard", "0/2", "--progress",
                      "none", file_bytes=2000)
        for run in runs:
            code, said = self.end(run)
            self.assertEqual(code, 0, said)
        self.succeed("verify", "out")
        self.assertEqual(manifest(self.folder / "out")["root_hash"], manifest(whole)["root_hash"])


if __name__ == "__main__":
    main()

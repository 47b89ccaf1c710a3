"""What the fault tests share: running the program within limits of time, memory and file size."""

import os
import pathlib
import resource
import signal
import subprocess
import sys
import threading

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "cli"))
from support import ProgramTest  # noqa: E402

GIB = 1 << 30


def limited(file_bytes=None, memory_bytes=None):
    """For preexec_fn: a disk that is full after so many bytes a file, an address space of so many bytes."""
    def apply():
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores both, which children inherit
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if file_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))
        if memory_bytes is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))
    return apply


# Sanitized programs are slower: how many times longer one may take.
PATIENCE = float(os.environ.get("ENSONIFY_TEST_PATIENCE", 1))
# ... and keep zones around all they allocate.
MEMORY_FACTOR = 3 if PATIENCE > 1 else 1


class FaultTest(ProgramTest):
    """Never a crash, never a hang, never an empty complaint."""

    seconds = 10
    most_memory = 1 * GIB

    def start(self, *words, file_bytes=None, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more):
        return subprocess.Popen([str(self.program), *map(os.fspath, words)], cwd=self.folder, stdout=stdout,
                                stderr=stderr, stdin=subprocess.DEVNULL, env=self.environment(),
                                preexec_fn=limited(file_bytes), **more)

    def run_limited(self, *words, file_bytes=None, seconds=None, **more):
        """Runs to the end within the limits; returns (code, standard output, standard error)."""
        process = self.start(*words, file_bytes=file_bytes, **more)
        try:
            out, err = process.communicate(timeout=(seconds or self.seconds) * PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.fail(f"{words}: hangs")
        out, err = ((text or b"").decode(errors="replace") for text in (out, err))
        self.assertGreaterEqual(process.returncode, 0, f"{words}: killed by signal {-process.returncode}\n{out}{err}")
        return process.returncode, out, err

    def complain(self, codes, fragments, *words, **more):
        """The program ends with one of `codes` and a complaint that holds every fragment, short and printable."""
        code, out, err = self.run_limited(*words, **more)
        self.assertIn(code, codes, f"{words}\n{out}{err}")
        self.assertTrue(err.startswith("ensonify: "), f"{words}: {err[:200]!r}")
        self.assertLess(len(err), 8000)
        self.assertFalse([c for c in err if c < " " and c not in "\n\t"], f"{words}: {err[:200]!r}")
        for fragment in fragments:
            self.assertIn(fragment, err, words)
        return err

    def measured(self, *words):
        """Like run_limited, and holds the peak of memory to its limit: (code, what it said)."""
        with open(os.devnull, "wb") as nothing, (self.folder / "said.txt").open("wb") as said:
            process = self.start(*words, stdout=nothing, stderr=said)
        timer = threading.Timer(self.seconds * PATIENCE, process.kill)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = code = os.waitstatus_to_exitcode(status)
        said = (self.folder / "said.txt").read_bytes().decode(errors="replace")
        (self.folder / "said.txt").unlink()
        self.assertNotEqual(code, -signal.SIGKILL, f"{words}: hangs")
        self.assertGreaterEqual(code, 0, f"{words}: killed by signal {-code}\n{said[:400]}")
        self.assertLess(usage.ru_maxrss * 1024, self.most_memory * MEMORY_FACTOR, words)
        return code, said


# Two blocks of random poses and one on a trajectory; a second or so.
TINY = """name: tiny
title: tiny
seed: 3
sonar: {model: small_sonar.yaml, range_max_m: 6, range_bins: 64}
noise: paper
splits:
  train:
    frames: 20
    places: [{scene: block.yaml, layouts: [0, 1]}]
    random_poses: {pitch_deg: {uniform: [0, 30]}, least_seen_share: 0.05}
  test:
    frames: 3
    places: [{scene: block.yaml, layouts: [2]}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
"""

#!/usr/bin/python3
"""Processes that end while threads compute: daemons, and a join that Ctrl-C broke off."""

import signal
import subprocess
import sys
import textwrap
import time

from module_test_support import ModuleTest, main

STARTS = """
import os, sys, threading, time
import ensonify

def tell(*news):
    os.write(1, b"made\\n")  # print() could hold a lock at the end that Python's own end needs

work = {work}

def forever():
    while True:
        work()
        tell()

thread = threading.Thread(target=forever, daemon={daemon})
thread.start()
"""

WORKS = {
    "pings": 'ensonify.Simulator("block.yaml", "small_sonar.yaml").ping(ensonify.pose(-4, -4, -2, pitch_deg=10, yaw_deg=45))',
    "frames": 'ensonify.Recipe("small.yaml").draw_frame("train", 1, [2])',
    "a set": 'ensonify.Recipe("small.yaml", pairs=100000).generate("set", progress=tell)',
    "a loop": 'ensonify.ClosedLoop("test_tank").explore(after_step=tell)',
    "a slow guest": 'ensonify.ClosedLoop("test_tank").explore(lambda look: tell() or time.sleep(0.3))',
}


class Ending(ModuleTest):
    def start(self, work, then="sys.stdin.readline()\n", daemon=True):
        """A process that has made something in its thread, and does `then` in the main one."""
        self.recipe()
        code = STARTS.format(work=f"lambda: {work}", daemon=daemon) + textwrap.dedent(then)
        process = subprocess.Popen([sys.executable, "-c", code], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, stdin=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), "made\n")
        return process

    def end(self, process):
        with process:
            _, said = process.communicate("end\n", timeout=60)
        return process.returncode, said

    def test_daemons_do_not_break_the_end(self):
        for name, work in WORKS.items():
            with self.subTest(name):
                self.assertEqual(self.end(self.start(work)), (0, ""))

    def test_the_end_may_still_ping(self):
        process = self.start(WORKS["pings"], f"""
            import atexit, ensonify
            atexit.register(lambda: open("late.txt", "w").write(str(work().raw.shape[1])))
            sys.stdin.readline()
        """)
        self.assertEqual(self.end(process), (0, ""))
        self.assertEqual((self.folder / "late.txt").read_text(), "48")

    def test_ctrl_c_in_a_join(self):
        process = self.start(WORKS["a loop"], "thread.join()\n", daemon=False)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)  # the first ended join(), this one the interpreter's wait for the thread
        code, said = self.end(process)
        self.assertIn("KeyboardInterrupt", said)
        self.assertIn(code, (1, 130, -signal.SIGINT))


if __name__ == "__main__":
    main()

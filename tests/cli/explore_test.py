#!/usr/bin/python3
"""ensonify explore as a user meets it: the loop, the gate's exit codes, plug-ins good and bad."""

import csv
import json
import math
import pathlib
import signal
import time
import unittest

import numpy

from support import ProgramTest, files, leftovers, main

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "examples"
RUN = ("block.yaml", "--sonar", "small_sonar.yaml", "--range-max", "8", "--progress", "none")

PLUGIN = """import json, os, sys, time
hello = json.loads(sys.stdin.readline())
for line in sys.stdin:
    step = json.loads(line)
    {body}
    print(json.dumps(answer), flush=True)
"""


def steps_of(folder):
    return list(csv.DictReader((folder / "steps.csv").read_text().splitlines()))


class ExploreTest(ProgramTest):
    def explore(self, out, *words):
        done = self.succeed("explore", *RUN, "--out", out, *words)
        return done, self.folder / out

    def plugin(self, body, name="plugin.py"):
        self.write(name, PLUGIN.format(body=body))
        return ("--plugin", f"/usr/bin/python3 {name}")

    def refuse_plugin(self, fragments, *words):
        done = self.refuse(1, fragments, "explore", *RUN, "--steps", "4", "--out", "broken", *words)
        self.assertFalse((self.folder / "broken").exists(), "nothing is left of a run that failed")
        return done

    def test_a_run_is_written_whole(self):
        _, out = self.explore("run", "--steps", "6", "--pictures-every", "3")
        self.assertEqual(sorted(p.name for p in out.iterdir()),
                         ["final.png", "map.npz", "map.pgm", "map.yaml", "step_000000.png", "step_000003.png",
                          "steps.csv", "steps.jsonl", "summary.json", "times.csv"])
        rows = steps_of(out)
        lines = [json.loads(line) for line in (out / "steps.jsonl").read_text().splitlines()]
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(len(rows), 6)
        self.assertEqual([float(r["coverage"]) for r in rows], [line["coverage"] for line in lines])
        self.assertEqual(summary["steps"], 6)
        self.assertAlmostEqual(summary["coverage"], float(rows[-1]["coverage"]), places=5)
        self.assertGreater(float(rows[-1]["coverage"]), float(rows[0]["coverage"]))
        for a, b in zip(rows, rows[1:]):
            way = math.hypot(float(b["x_m"]) - float(a["x_m"]), float(b["y_m"]) - float(a["y_m"]))
            self.assertLessEqual(way, 0.2501)
            turn = (float(b["yaw_deg"]) - float(a["yaw_deg"]) + 180) % 360 - 180
            self.assertLessEqual(abs(turn), 15.001)
        log_odds = numpy.load(out / "map.npz")["log_odds"]
        self.assertTrue((log_odds > 0).any() and (log_odds < 0).any() and (log_odds == 0).any())

    def test_the_same_seed_gives_the_same_run_on_any_number_of_threads(self):
        hashes = [files(self.explore(f"run{i}", "--steps", "8", "--drift", "1.1", *words)[1], ignore=("times.csv",))
                  for i, words in enumerate(((), ("--jobs", "1"), ("--jobs", "2")))]
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(hashes[0], hashes[2])
        self.assertNotEqual(hashes[0], files(self.explore("other", "--steps", "8", "--drift", "1.1", "--seed", "9")[1],
                                             ignore=("times.csv",)))

    def test_under_drift_the_mapper_sees_other_poses_than_the_sonar(self):
        _, out = self.explore("drift", "--steps", "8", "--drift", "50")
        rows = steps_of(out)
        off = [math.hypot(float(r["est_x_m"]) - float(r["x_m"]), float(r["est_y_m"]) - float(r["y_m"])) for r in rows]
        self.assertEqual(off[0], 0)
        self.assertGreater(off[-1], 0.01)
        self.assertTrue(all(r["est_x_m"] == r["x_m"] for r in steps_of(self.explore("none", "--steps", "3")[1])))

    def test_the_gate_sets_the_exit_code(self):
        self.write("good.yaml", "coverage_at_least: 0.01\nclearance_at_least_m: 0.3\nfpr_at_most: 1\nwithin_steps: 4\n")
        done, out = self.explore("good", "--steps", "4", "--gate", "good.yaml")
        self.assertIn("gate: clearance_m", done.stdout)
        self.assertEqual(done.stdout.count(": passed"), 3)
        self.assertTrue(all(line["passed"] for line in json.loads((out / "summary.json").read_text())["gate"]))
        self.write("bad.yaml", "coverage_at_least: 1\n")
        done = self.refuse(1, [], "explore", *RUN, "--steps", "4", "--out", "bad", "--gate", "bad.yaml")
        self.assertIn(">= 1: failed", done.stdout)
        self.assertTrue((self.folder / "bad/summary.json").exists(), "a run that fails its gate is whole")

    def test_gates_are_read_strictly(self):
        for text, fragment in (("coverage_at_lest: 0.9\n", "coverage_at_least"), ("coverage_at_least: 90\n", "[0, 1]"),
                               ("within_steps: 3\n", "no bound"), ("fpr_at_most: .nan\n", "fpr_at_most")):
            self.write("gate.yaml", text)
            self.refuse(2, [fragment], "explore", *RUN, "--steps", "2", "--out", "gate", "--gate", "gate.yaml")
            self.assertFalse((self.folder / "gate").exists())

    def test_what_does_not_fit_is_said_before_the_start(self):
        for words, fragment in ((("--start", "1 2 3"), "--start"), (("--start", "0 0 -3.5 0 0 0"), "choose another start"),
                                (("--start", "50 0 -2 0 0 0"), "outside of the scene's navigable box"), (("--depth", "40"), "another depth or height"),
                                (("--model", "oracle"), "--model"), (("--known-free", "9"), "known-free radius"),
                                (("--filter", "nosuch"), "nosuch"), (("--steps", "0"), "--steps")):
            self.refuse(2, [fragment], "explore", *RUN, "--out", "wrong", *words)
            self.assertFalse((self.folder / "wrong").exists(), words)

    def test_a_folder_holds_one_run(self):
        self.explore("run", "--steps", "3")
        self.refuse(2, ["--force"], "explore", *RUN, "--steps", "2", "--out", "run")
        self.write("run/notes.txt", "mine")
        _, out = self.explore("run", "--steps", "2", "--force")
        self.assertEqual(len(steps_of(out)), 2)
        self.assertEqual((out / "notes.txt").read_text(), "mine")

    def test_a_planner_as_a_plugin(self):
        _, out = self.explore("plugin", "--steps", "12", "--plugin",
                              f"/usr/bin/python3 {EXAMPLES / 'plugin_planner.py'}")
        rows = steps_of(out)
        self.assertEqual(len(rows), 12)
        self.assertGreater(float(rows[-1]["coverage"]), float(rows[0]["coverage"]))
        self.assertFalse((out / "plugin").exists(), "what the plug-in was shown is gone")

    def test_a_plugin_is_told_all_and_kept_within_the_limits(self):
        body = ("shown = sorted(os.listdir(os.path.dirname(step['raw'])))\n"
                "    open('seen.json', 'w').write(json.dumps([hello, step, shown]))\n"
                "    answer = {'pose': [100, 0, 0, 0, 0, 45]}")
        _, out = self.explore("far", "--steps", "3", *self.plugin(body))
        rows = steps_of(out)
        self.assertAlmostEqual(float(rows[2]["x_m"]) - float(rows[0]["x_m"]), 0.5, places=2)
        hello, step, shown = json.loads((self.folder / "seen.json").read_text())
        self.assertEqual(len(hello["sonar"]["beam_azimuth_rad"]), 48)
        self.assertEqual(shown, ["filtered.png", "map.npz", "raw.png"])
        self.assertEqual(numpy.array(step["T_world_sonar_est"]).shape, (4, 4))

    def test_a_plugin_may_end_the_run_or_give_a_map(self):
        done, out = self.explore("done", "--steps", "5", *self.plugin("answer = {'done': True}"))
        self.assertEqual(json.loads((out / "summary.json").read_text())["end"], "plugin_done")
        body = ("import numpy\n"
                "    z = numpy.load(step['map'])\n"
                "    free = -numpy.ones_like(z['log_odds'])\n"
                "    numpy.savez('mine.npz', log_odds=free, origin=z['origin'], resolution=z['resolution'])\n"
                "    answer = {'map': 'mine.npz', 'done': True}")
        _, out = self.explore("map", "--steps", "5", *self.plugin(body))
        last = json.loads((out / "summary.json").read_text())
        self.assertEqual((last["coverage"], last["fpr"], last["fnr"]), (1, 1, 0))

    def test_a_plugin_that_dies(self):
        self.refuse_plugin(["ended"], *self.plugin("sys.exit(3)"))
        self.refuse_plugin(["plug-in"], "--plugin", "/nowhere/program")
        self.refuse_plugin(["plug-in"], "--plugin", "true")

    def test_a_plugin_that_hangs_is_killed_with_all_its_children(self):
        body = ("import subprocess\n    child = subprocess.Popen(['sleep', '60'])\n"
                "    open('pids', 'w').write(f'{os.getpid()} {child.pid}')\n    time.sleep(60)\n    answer = {}")
        start = time.monotonic()
        self.refuse_plugin(["did not answer within 1.5 s", "--plugin-timeout"], "--plugin-timeout", "1.5",
                           *self.plugin(body))
        self.assertLess(time.monotonic() - start, 20)
        for pid in (self.folder / "pids").read_text().split():
            status = pathlib.Path(f"/proc/{pid}/status")
            self.assertTrue(not status.exists() or "Z (zombie)" in status.read_text(), f"{pid} still runs")

    def test_a_plugin_that_talks_nonsense(self):
        for body, fragment in (("answer = 'hello'", "must be an object"), ("answer = {'pose': [1, 2]}", "six numbers"),
                               ("answer = {'pose': [float('nan')] * 6}", "no JSON"),
                               ("answer = {'goto': 1}", "goto"), ("answer = {'map': 'missing.npz'}", "missing.npz"),
                               ("print('{', flush=True); answer = {}", "no JSON"),
                               ("sys.stdout.write('x' * 3000000); answer = {}", "1 MiB")):
            self.refuse_plugin([fragment], *self.plugin(body))

    def test_a_signal_leaves_nothing_and_no_plugin_behind(self):
        words = self.plugin("open('pid', 'w').write(str(os.getpid()))\n    time.sleep(60)\n    answer = {}")
        running = self.start_program("explore", *RUN, "--out", "stopped", "--plugin-timeout", "60", *words)
        for _ in range(200):
            if (self.folder / "pid").exists() and (self.folder / "pid").read_text():
                break
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=20)
        self.assertEqual(running.returncode, 130)
        self.assertFalse((self.folder / "stopped").exists())
        pid = (self.folder / "pid").read_text()
        status = pathlib.Path(f"/proc/{pid}/status")
        self.assertTrue(not status.exists() or "Z (zombie)" in status.read_text())
        self.assertEqual(leftovers(self.folder), [])


if __name__ == "__main__":
    main()

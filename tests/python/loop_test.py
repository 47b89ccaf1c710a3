#!/usr/bin/python3
"""The closed loop from Python: the program's steps, guests in the same process, and the manners of an environment."""

import json
import math
import os
import signal
import threading
import unittest

import numpy

import ensonify
import ensonify.gym
from module_test_support import ModuleTest, main


class Loop(ModuleTest):
    def test_explores_as_the_program_does(self):
        self.succeed("explore", "test_tank", "--out", "run", "--steps", 6, "--seed", 3, "--drift", 2, "--progress", "none")
        run = ensonify.ClosedLoop("test_tank", drift_m=2).explore(steps=6, seed=3)
        steps = [json.loads(line) for line in (self.folder / "run/steps.jsonl").read_text().splitlines()]
        self.assertEqual(run.steps, steps)
        self.assertEqual((run.end, len(run.steps)), ("all_steps", 6))
        self.assertSameBits(run.map().log_odds, numpy.load(self.folder / "run/map.npz")["log_odds"])

    def test_a_guest_that_repeats_our_moves_makes_our_run(self):
        loop = ensonify.ClosedLoop("test_tank")
        ours = loop.explore(steps=5)
        poses = [(s["est_x_m"], s["est_y_m"], math.radians(s["est_yaw_deg"])) for s in ours.steps]
        looks = []

        def guest(look):
            looks.append((look.step, digest_of(look.map()), look.raw.shape))
            return {"wanted": poses[look.step + 1]} if look.step < 4 else {"done": True}

        run = loop.explore(guest, steps=50)
        self.assertEqual(run.end, "plugin_done")
        for a, b in zip(run.steps, ours.steps):
            for key in a:
                self.assertAlmostEqual(a[key] or 0, b[key] or 0, 4, key)
        self.assertEqual([step for step, _, _ in looks], list(range(5)))
        self.assertEqual(len({d for _, d, _ in looks}), 5)

    def test_a_guests_map_is_what_counts(self):
        loop = ensonify.ClosedLoop("test_tank")

        def blind(look):
            return {"map": ensonify.Map(numpy.zeros((1, 4, 4), numpy.float32), [0, 0, -2], 0.1), "wanted": (0, 0, 0)}

        self.assertEqual(loop.explore(blind, steps=2).steps[-1]["coverage"], 0)

    def test_mistakes_of_guests(self):
        loop = ensonify.ClosedLoop("test_tank")
        for kind, fragment, guest in [
                (ZeroDivisionError, "", lambda look: 1 / 0), (TypeError, "None or a dict", lambda look: 5),
                (ensonify.ConfigError, "'wnted'", lambda look: {"wnted": 1}), (ValueError, "three finite", lambda look: {"wanted": (1, 2)}),
                (ValueError, "three finite", lambda look: {"wanted": (1, 2, math.nan)}), (TypeError, "ensonify.Map, not int", lambda look: {"map": 5}),
                (TypeError, "bool, not str", lambda look: {"done": "no"})]:
            with self.subTest(fragment), self.assertRaisesRegex(kind, fragment):
                loop.explore(guest, steps=3)
        self.assertEqual(loop.explore(steps=3, after_step=lambda step, scores: step < 1).end, "stopped")
        kept = []
        loop.explore(lambda look: kept.append(look), steps=2)
        with self.assertRaisesRegex(RuntimeError, "moved on"):
            kept[0].map()
        self.assertEqual(kept[0].raw.shape, (512, 512))

        def keeps_and_fails(look):
            kept.append(look)
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            loop.explore(keeps_and_fails, steps=2)
        with self.assertRaisesRegex(RuntimeError, "moved on"):
            kept[-1].map()

    def test_what_a_guest_sees_of_the_way_is_what_the_run_tells(self):
        seen = []
        run = ensonify.ClosedLoop("test_tank").explore(lambda look: seen.append(look.scores), steps=4)
        for scores, step in zip(seen, run.steps, strict=True):
            for key in ("coverage", "clearance_m", "path_m"):
                self.assertAlmostEqual(scores[key], step[key], 5, key)
        self.assertGreater(seen[-1]["path_m"], 0)

    def test_a_loop_at_work_is_left_alone(self):
        loop = ensonify.ClosedLoop("test_tank")
        for meddle in (loop.reset, loop.close, loop.look, lambda: loop.explore(steps=1)):
            with self.assertRaisesRegex(RuntimeError, "at work|reset"):
                loop.explore(lambda look, m=meddle: m(), steps=2)
        self.assertEqual(loop.explore(steps=2).end, "all_steps")

    def test_ctrl_c_ends_it(self):
        loop = ensonify.ClosedLoop("test_tank")
        steps = []

        def after(step, scores):
            steps.append(step)
            if step == 2:
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            loop.explore(steps=1000, after_step=after)
        self.assertLess(len(steps), 6)
        self.assertEqual(loop.explore(steps=2).end, "all_steps")

    def test_ctrl_c_ends_a_dataset_that_can_be_resumed(self):
        recipe = ensonify.Recipe(self.recipe(train=600, test=2))
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            recipe.generate(self.folder / "set")
            signal.pause()  # where the set was there first
        self.assertEqual(recipe.generate(self.folder / "set"), "complete")
        self.succeed("verify", "set")

    def test_look_and_move_take_turns(self):
        loop = ensonify.ClosedLoop("test_tank")
        for call in (loop.look, lambda: loop.move((0, 0, 0))):
            with self.assertRaisesRegex(RuntimeError, "reset"):
                call()
        loop.reset(seed=1)
        with self.assertRaisesRegex(RuntimeError, r"look\(\) first"):
            loop.move((0, 0, 0))
        look = loop.look()
        with self.assertRaisesRegex(RuntimeError, r"move\(\) before"):
            loop.look()
        before = look.pose_est
        loop.move((before[0, 3] + 5, before[1, 3], 0))
        step_m, _ = loop.steps_m_rad
        self.assertAlmostEqual(loop.look().pose_est[0, 3] - before[0, 3], step_m)
        loop.close()
        with self.assertRaisesRegex(RuntimeError, "reset"):
            loop.look()

    def test_a_sonar_that_looks_straight_down_does_so(self):
        for roll_deg, pitch_deg in [(0, 90), (20, 90), (10, -90), (0, 0)]:
            start = ensonify.pose(0, 1.3, -1.7, roll_deg=roll_deg, pitch_deg=pitch_deg, yaw_deg=30)
            loop = ensonify.ClosedLoop("test_tank", start=start, noise="none", range_max_m=6)
            loop.reset()
            numpy.testing.assert_allclose(loop.look().pose, start, atol=2e-6)
            turned = ensonify.pose(0, 1.3, -1.7, **dict(zip(("roll_deg", "pitch_deg", "yaw_deg"), ensonify.roll_pitch_yaw_deg(start))))
            numpy.testing.assert_allclose(turned, start, atol=2e-6)

    def test_arguments(self):
        for kind, options in [(ensonify.ConfigError, {"model": "oracle"}), (ensonify.ConfigError, {"filter": "leee"}), (ValueError, {"radius_m": 0}),
                              (ValueError, {"speed_mps": math.nan}), (ValueError, {"steps": 0}), (ValueError, {"start": numpy.zeros((4, 4))}),
                              (ValueError, {"drift_m": -1}), (ValueError, {"known_free_m": -1}),
                              (ensonify.ConfigError, {"start": ensonify.pose(50, 0, -1.5)}), (TypeError, {"sonar": 5})]:
            with self.subTest(options), self.assertRaises(kind):
                ensonify.ClosedLoop("test_tank", **options).reset()


def digest_of(map_):
    return hash(map_.log_odds.tobytes())


class Environment(ModuleTest):
    @classmethod
    def setUpClass(cls):
        cls.env = ensonify.gym.ExploreEnv("test_tank", steps=8, window=40)

    def run_episode(self, seed, actions):
        result = [self.env.reset(seed=seed)]
        for action in actions:
            result.append(self.env.step(action))
        return result

    def test_the_same_seed_and_actions_make_the_same_episode(self):
        actions = [[0.5, 0, 1], [0, -0.3, 1], [0.2, 0.2, -1]]
        one, two = self.run_episode(4, actions), self.run_episode(4, actions)
        for a, b in zip(one, two):
            for key in a[0]:
                self.assertSameBits(a[0][key], b[0][key], key)
            self.assertEqual(a[1] if len(a) == 5 else 0, b[1] if len(b) == 5 else 0)
        other = self.run_episode(5, [])
        self.assertFalse(numpy.array_equal(other[0][0]["image"], one[0][0]["image"]))
        self.env.reset(seed=7)
        first = self.env.reset()[0]["image"]
        self.assertFalse(numpy.array_equal(self.env.reset()[0]["image"], first))
        self.env.reset(seed=7)
        self.assertSameBits(self.env.reset()[0]["image"], first)

    def test_observation_reward_and_info(self):
        observation, info = self.env.reset(seed=1)
        self.assertEqual({k: (v.shape, v.dtype.str) for k, v in observation.items()},
                         {"image": ((512, 512), "|u1"), "pose": ((3,), "<f4"), "map": ((40, 40), "|u1")})
        total = 0.0
        before = info
        for _ in range(4):
            observation, reward, terminated, truncated, info = self.env.step([0, 0, 1])
            total += reward
            self.assertIs(type(terminated), bool)
        self.assertAlmostEqual(total, info["coverage"] - before["coverage"] + info["boundary_found"] - before["boundary_found"], 9)
        self.assertGreater(total, 0.05)
        self.assertEqual((info["step"], info["time_s"]), (4, 2.0))
        # It turned left by four steps, in place.
        _, turn = self.env.loop.steps_m_rad
        self.assertAlmostEqual(observation["pose"][2], 4 * turn, 5)
        self.assertEqual(observation["pose"][:2].tolist(), numpy.float32(before["pose"][:2, 3]).tolist())

    def test_forward_and_left_are_the_vehicles(self):
        self.env.reset(seed=1)
        for _ in range(6):
            observation = self.env.step([0, 0, 1])[0]    # to face north
        x, y, yaw = observation["pose"]
        self.assertAlmostEqual(float(yaw), math.pi / 2, 5)
        step_m, _ = self.env.loop.steps_m_rad
        moved = self.env.step([0.4, 0.2, 0])[0]["pose"]
        numpy.testing.assert_allclose(moved[:2] - [x, y], [-0.2 * step_m, 0.4 * step_m], atol=1e-5)

    def test_truncated_after_its_steps_and_over_then(self):
        self.env.reset(seed=1)
        ends = [self.env.step([0, 0, 0])[2:4] for _ in range(7)]
        self.assertEqual(ends, [(False, False)] * 6 + [(False, True)])
        with self.assertRaisesRegex(RuntimeError, "reset"):
            self.env.step([0, 0, 0])

    def test_terminated_aground_with_a_penalty(self):
        env = ensonify.gym.ExploreEnv("test_tank", steps=200)
        env.reset(seed=1)
        for _ in range(200):
            _, reward, terminated, _, info = env.step([1, 0, 0])
            if terminated:
                break
        self.assertTrue(terminated)
        self.assertEqual(info["clearance_m"], 0)
        self.assertLess(reward, -0.5)

    def test_terminated_at_the_goal(self):
        env = ensonify.gym.ExploreEnv("test_tank", goal=0.3)
        env.reset(seed=1)
        self.assertTrue(env.step([0, 0, 1])[2])

    def test_the_window_is_the_map_about_the_vehicle_north_up(self):
        columns = numpy.arange(20, dtype=numpy.uint8).reshape(4, 5)
        cut = ensonify.gym._cut(columns, 1, 2, 3)
        self.assertEqual(cut.tolist(), columns[0:3, 1:4].tolist())
        corner = ensonify.gym._cut(columns, 0, 0, 3)
        self.assertEqual(corner.tolist(), [[0, 0, 0], [0, 0, 1], [0, 5, 6]])
        self.assertEqual(int(ensonify.gym._cut(columns, 50, 50, 3).sum()), 0)

    def test_wrong_use(self):
        for kind, call in [(ValueError, lambda: ensonify.gym.ExploreEnv("test_tank", window=0)), (ValueError, lambda: ensonify.gym.ExploreEnv("test_tank", goal=0)),
                           (ValueError, lambda: ensonify.gym.ExploreEnv("test_tank", render_mode="human")), (ValueError, lambda: self.env.reset(options={"fog": 1})),
                           (TypeError, lambda: ensonify.gym.ExploreEnv("test_tank", sped_mps=1))]:
            with self.assertRaises(kind):
                call()
        self.env.reset(seed=1)
        for action in ([1, 2], [0, 0, math.nan], "ab"):
            with self.assertRaises(ValueError):
                self.env.step(action)
        env = ensonify.gym.ExploreEnv("test_tank", render_mode="rgb_array")
        self.assertIsNone(env.render())
        env.reset(seed=1)
        self.assertEqual(env.render().shape[2], 3)
        env.close()
        with self.assertRaisesRegex(RuntimeError, "reset"):
            env.step([0, 0, 0])

    @unittest.skipIf(ensonify.gym._gymnasium is None, "gymnasium is not installed")
    def test_gymnasium_agrees(self):
        from gymnasium.utils.env_checker import check_env
        check_env(self.env, skip_render_check=True)


if __name__ == "__main__":
    main()

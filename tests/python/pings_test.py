#!/usr/bin/python3
"""Pings and frames: the bits of the command line, as arrays that numpy users expect."""

import gc
import threading
import time

import numpy

import ensonify
from module_test_support import POSE, ModuleTest, main, read_grey

IMAGES = ("raw", "clean", "mask", "labels")


class SameBitsAsTheProgram(ModuleTest):
    def test_a_ping_with_every_option(self):
        self.succeed("ping", "block.yaml", "--layout", 1, "--sonar", "small_sonar.yaml", "--range-max", 8, "--range-bins", 128,
                     "--noise", "oculus_open_water", "--seed", 7, "--frame", 3, "--velocity", "1 0.2 0 0 0 20",
                     "--pose", "-4 -4 -2 0 10 45", "--out", "ping")
        ping = ensonify.Simulator(self.scene(1), self.sonar(), "oculus_open_water").ping(
            POSE, seed=7, frame=3, velocity=(1, 0.2, 0, 0, 0, 20))
        for kind in IMAGES:
            self.assertSameBits(getattr(ping, kind), read_grey(self.folder / f"ping/{kind}.png"), kind)
        self.assertGreater(numpy.count_nonzero(ping.mask), 100)
        self.assertIsNotNone(ping.multipath)

    def test_frames_of_a_set_and_the_set_itself(self):
        out = self.generate("by_program", recipe=self.recipe(train=6, test=4))
        recipe = ensonify.Recipe(self.folder / "small.yaml")
        self.assertEqual((len(recipe), recipe.splits), (10, {"train": 6, "test": 4}))
        self.assertRegex(repr(recipe.make_frame(7)), "Frame 1 of test in block: 128 x 48 of small")
        program = ensonify.open_dataset(out)
        for index, (split, number) in enumerate([("train", n) for n in range(6)] + [("test", n) for n in range(4)]):
            frame = recipe.make_frame(index)
            images = program.images(split, number)
            for kind in IMAGES:
                self.assertSameBits(getattr(frame, kind), images[kind], (index, kind))
            info = program.info(split, number)
            self.assertEqual((frame.split, frame.number, frame.place), (split, number, info["place"]))
            numpy.testing.assert_allclose(frame.pose, info["T_world_sonar"], atol=1e-12)
            numpy.testing.assert_allclose(frame.pose_est, info["T_world_sonar_est"], atol=1e-12)
        calls = []
        self.assertEqual(recipe.generate(self.folder / "by_python", progress=lambda *a: calls.append(a)), "complete")
        self.assertEqual(ensonify.open_dataset(self.folder / "by_python").root_hash, program.root_hash)
        self.succeed("verify", "by_python")

    def test_make_frame_by_name_is_the_recipes(self):
        path = self.recipe(train=4, test=2)
        self.assertSameBits(ensonify.make_frame(path, 3).raw, ensonify.Recipe(path).make_frame(3).raw)
        self.assertSameBits(ensonify.make_frame(path, 3).raw, ensonify.Recipe(path).make_frame(-3).raw)
        with self.assertRaisesRegex(IndexError, "frames 0 to 5"):
            ensonify.make_frame(path, 6)

    def test_a_dict_says_what_a_file_says(self):
        sonar = ensonify.config("sonar", self.folder / "small_sonar.yaml")
        scene = {**ensonify.config("scene", self.folder / "block.yaml"), "name": "block"}
        noise = ensonify.Noise("oculus_tank").to_dict()
        by_dict = ensonify.Simulator(scene, ensonify.Sonar(sonar, range_max_m=8, range_bins=128), noise).ping(POSE, seed=4)
        by_file = self.simulator("oculus_tank").ping(POSE, seed=4)
        self.assertSameBits(by_dict.raw, by_file.raw)
        for name in ensonify.noise_names():
            self.assertEqual(ensonify.Noise(ensonify.Noise(name).to_dict()).to_dict(), ensonify.Noise(name).to_dict())


class Arrays(ModuleTest):
    def test_are_writable_views_that_keep_the_ping_alive(self):
        ping = self.simulator("oculus_open_water").ping(POSE)
        kinds = {"raw": "u1", "clean": "u1", "mask": "u1", "labels": "u1", "raw_level": "f4", "clean_level": "f4",
                 "direct": "f4", "multipath": "f4", "sidelobe": "f4", "elevation": "f4", "elevation_min": "f4",
                 "elevation_max": "f4", "incidence": "f4", "instance": "i4"}
        for name, dtype in kinds.items():
            array = getattr(ping, name)
            self.assertEqual((array.shape, array.dtype), ((128, 48), numpy.dtype(dtype)), name)
            self.assertTrue(array.flags.writeable and array.flags.c_contiguous and not array.flags.owndata, name)
            self.assertEqual(array.ctypes.data, getattr(ping, name).ctypes.data, name)
        self.assertEqual((ping.shadow_start_bin.shape, ping.shadow_start_bin.dtype), ((48,), numpy.dtype("i4")))
        raw = ping.raw
        raw[5, 6] = 123
        self.assertEqual(ping.raw[5, 6], 123)
        kept = raw.copy()
        del ping
        gc.collect()
        self.assertSameBits(raw, kept)

    def test_mean_what_they_say(self):
        scene = self.scene()
        ping = self.simulator("none").ping(POSE)
        self.assertSameBits(ping.mask, numpy.where(ping.clean >= 8, numpy.uint8(255), numpy.uint8(0)))
        self.assertSameBits(ping.raw, ping.clean)
        echoes = ping.instance >= 0
        self.assertTrue(numpy.isfinite(ping.elevation[echoes]).all())
        self.assertTrue(numpy.isnan(ping.elevation[~echoes]).all())
        strong = ping.direct > numpy.quantile(ping.direct[ping.direct > 0], 0.9)
        self.assertTrue((ping.mask[strong] == 255).all())
        names = {scene.objects[i][0] for i in numpy.unique(ping.instance[echoes])}
        self.assertEqual(names, {"seabed", "block"})
        # The strongest echo of every pixel is where the geometry puts it: on the sea floor, within a bin and a ray.
        rows, columns = numpy.nonzero(ping.instance == [n for n, _ in scene.objects].index("seabed"))
        r, theta, phi = ping.sonar.range_m[rows], ping.sonar.azimuth_rad[columns], ping.elevation[rows, columns]
        p_sonar = numpy.stack([r * numpy.cos(phi) * numpy.cos(theta), r * numpy.cos(phi) * numpy.sin(theta), r * numpy.sin(phi)])
        p_world = ping.pose[:3, :3] @ p_sonar + ping.pose[:3, 3:]
        self.assertLess(numpy.abs(p_world[2] + 4).max(), 0.2)

    def test_what_was_not_asked_for_is_none(self):
        ping = self.simulator("paper").ping(POSE, truth=False)
        for name in ("multipath", "sidelobe", "elevation", "elevation_min", "elevation_max", "incidence", "instance"):
            self.assertIsNone(getattr(ping, name), name)

    def test_every_bundled_thing_has_a_name(self):
        self.assertIn("test_tank", ensonify.scene_names())
        self.assertIn("oculus_m1200d_hf", ensonify.sonar_names())
        self.assertIn("oculus_tank", ensonify.noise_names())
        self.assertIn("paper", ensonify.recipe_names())
        self.assertIn("lee", ensonify.filter_names())


class Randomness(ModuleTest):
    def test_seed_and_frame_name_the_noise(self):
        simulator = self.simulator("oculus_tank")
        same = simulator.ping(POSE, seed=1).raw
        self.assertSameBits(simulator.ping(POSE, seed=1).raw, same)
        self.assertSameBits(self.simulator("oculus_tank").ping(POSE, seed=1).raw, same)
        self.assertFalse(numpy.array_equal(simulator.ping(POSE, seed=2).raw, same))
        self.assertFalse(numpy.array_equal(simulator.ping(POSE, seed=1, frame=1).raw, same))

    def test_threads_do_not_matter(self):
        simulator = self.simulator("oculus_tank")
        try:
            ensonify.set_threads(1)
            one = simulator.ping(POSE).raw
            ensonify.set_threads(2)
            self.assertSameBits(simulator.ping(POSE).raw, one)
        finally:
            ensonify.set_threads(0)

    def test_drawn_frames_follow_from_their_address_alone(self):
        recipe, again = (ensonify.Recipe(self.recipe()) for _ in range(2))
        frames = {address: recipe.draw_frame("train", 3, list(address)).raw.tobytes() for address in
                  [(0, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0)]}
        self.assertEqual(len(set(frames.values())), 4)
        for address in reversed(frames):
            self.assertEqual(again.draw_frame("train", 3, list(address)).raw.tobytes(), frames[address])
        self.assertNotEqual(recipe.draw_frame("train", 4, [0, 0, 0]).raw.tobytes(), frames[0, 0, 0])
        self.assertEqual(recipe.draw_frame("train", 3, [0, 0, 0]).index, -1)
        with self.assertRaisesRegex(ensonify.ConfigError, "trajectories"):
            recipe.draw_frame("test", 3, [0])


class TheLock(ModuleTest):
    def test_other_threads_run_while_a_ping_is_made(self):
        simulator = ensonify.Simulator("test_tank", "oculus_m1200d_hf")
        pose = ensonify.pose(1, 0, -1.5, pitch_deg=10)
        simulator.ping(pose)
        done = threading.Event()

        def work():
            for seed in range(8):
                simulator.ping(pose, seed)
            done.set()

        # Were the lock held, this thread would wake at most once between two pings.
        wakes = 0
        thread = threading.Thread(target=work)
        thread.start()
        while not done.is_set():
            time.sleep(0.0005)
            wakes += 1
        thread.join()
        self.assertGreater(wakes, 3 * 8)

    def test_pings_of_several_threads_are_the_same(self):
        simulator = self.simulator("oculus_tank")
        results = {}
        threads = [threading.Thread(target=lambda s=s: results.update({s: simulator.ping(POSE, s).raw.tobytes()}))
                   for s in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed, raw in results.items():
            self.assertEqual(simulator.ping(POSE, seed).raw.tobytes(), raw)


if __name__ == "__main__":
    main()

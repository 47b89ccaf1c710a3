#!/usr/bin/python3
"""Nothing leaks: the memory of the process stays as it is while objects come, go, and fail."""

import gc
import os

import numpy

import ensonify
import ensonify.data
from module_test_support import POSE, ModuleTest, main

PAGE = os.sysconf("SC_PAGE_SIZE")


def resident_bytes():
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * PAGE


def ignore(call):
    try:
        call()
    except Exception:  # noqa: BLE001
        return
    raise AssertionError("it should have failed")


class Memory(ModuleTest):
    def assertFlat(self, work, rounds, bytes_each):
        """`rounds` times work() takes less than a fifth of what the same would take that kept `bytes_each` a round."""
        for _ in range(max(3, rounds // 10)):
            work()
        before = resident_bytes()
        for _ in range(rounds):
            work()
        self.assertLess(resident_bytes() - before, max(rounds * bytes_each / 5, 4 << 20))

    def test_pings_and_their_arrays(self):
        simulator = self.simulator("oculus_tank")
        image_bytes = 128 * 48 * 4

        def work():
            ping = simulator.ping(POSE)
            kept = [ping.raw, ping.direct, ping.elevation, ping.sampled, ping.pose, ping.shadow_start_bin]
            del ping
            self.assertEqual(kept[0].shape, (128, 48))

        self.assertFlat(work, 2000, 15 * image_bytes)

    def test_frames_without_end(self):
        frames = iter(ensonify.data.EndlessFrames(str(self.recipe()), fields=ensonify.data.LAYERS))
        self.assertFlat(lambda: next(frames), 2000, 128 * 48 * 4 * 10)

    def test_filters_maps_and_grids(self):
        image = numpy.random.default_rng(1).integers(0, 255, (256, 256), dtype=numpy.uint8)
        lee = ensonify.Filter("lee")
        cells = numpy.zeros((20, 40, 40), numpy.float32)

        def work():
            lee(image)
            ensonify.Map(cells, [0, 0, 0], 0.1).log_odds.sum()
            ensonify.Mapper([[0, 0, 0], [1, 1, 1]], 0.1).map()
            ensonify.score_image(image, image)

        self.assertFlat(work, 500, 256 * 256 * 4 + cells.nbytes)

    def test_simulators_scenes_and_recipes(self):
        def work():
            self.simulator().ping(POSE)
            ensonify.Recipe(str(self.folder / "small.yaml")).make_frame(0)

        self.recipe()
        self.assertFlat(work, 60, 600_000)

    def test_what_fails(self):
        simulator = self.simulator()
        broken = self.write("broken.obj", "v 0 0 nan\nf 1 2 3\n")
        strided = numpy.zeros((512, 512), numpy.uint8)[::2]

        def work():
            ignore(lambda: simulator.ping(numpy.full((4, 4), numpy.nan)))
            ignore(lambda: ensonify.Filter("median")(strided))
            ignore(lambda: ensonify.Scene(broken))
            ignore(lambda: ensonify.Noise({"name": "x" * 5000, "stages": [{"stage": "gaussian"}]}))
            ignore(lambda: ensonify.open_dataset(self.folder))

        self.assertFlat(work, 1000, 20_000)

    def test_loops_and_guests_that_fail(self):
        loop = ensonify.ClosedLoop("test_tank", sonar=self.sonar())

        def work():
            ignore(lambda: loop.explore(lambda look: {"map": look.map(), "x": 1}, steps=2))
            loop.reset()
            loop.look().map()
            loop.close()

        self.assertFlat(work, 60, 2_000_000)


if __name__ == "__main__":
    main()

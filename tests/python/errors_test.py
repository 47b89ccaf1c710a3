#!/usr/bin/python3
"""Whatever does not fit raises the right exception of Python with the reason; nothing crashes, nothing is converted in
silence."""

import io
import pathlib

import numpy

import ensonify
from module_test_support import POSE, ModuleTest, main

GREY = numpy.zeros((16, 12), numpy.uint8)
NAN_POSE = numpy.full((4, 4), numpy.nan)


def scaled(pose):
    return numpy.diag([2.0, 2, 2, 1]) @ pose


class Wrong(ModuleTest):
    def refuse(self, kind, fragment, call):
        with self.assertRaisesRegex(kind, fragment) as caught:
            call()
        self.assertIs(type(caught.exception), kind)

    def test_poses(self):
        ping = self.simulator().ping
        for kind, fragment, pose in [
                (ValueError, "not finite", NAN_POSE), (ValueError, "4 x 4", numpy.eye(3)), (ValueError, "4 x 4", numpy.zeros(16)),
                (ValueError, "rigid", scaled(POSE)), (ValueError, "rigid", numpy.diag([1.0, 1, -1, 1])),
                (ValueError, "rigid", numpy.zeros((4, 4))), (ValueError, "100000", numpy.eye(4) + numpy.eye(4, k=3) * 1e6),
                (TypeError, "not str", "1 2 3 4 5 6"), (TypeError, "not NoneType", None), (TypeError, "not dict", {})]:
            with self.subTest(fragment, pose=str(pose)[:20]):
                self.refuse(kind, fragment, lambda pose=pose: ping(pose))
        self.refuse(ValueError, "not finite", lambda: ensonify.pose(0, float("nan"), 0))
        self.refuse(ValueError, "100000", lambda: ensonify.pose(1e9, 0, 0))
        self.refuse(TypeError, "incompatible", lambda: ensonify.pose(0, 0, 0, 10))
        self.refuse(TypeError, "4 x 4", lambda: ping(POSE.astype(complex)))
        self.assertEqual(ping(POSE.tolist()).raw.tobytes(), ping(numpy.asfortranarray(POSE)).raw.tobytes())

    def test_other_arguments_of_a_ping(self):
        ping = self.simulator().ping
        self.refuse(TypeError, "incompatible", lambda: ping(POSE, seed=-1))
        self.refuse(TypeError, "incompatible", lambda: ping(POSE, seed=1.5))
        self.refuse(ValueError, "none beyond 180", lambda: ping(POSE, velocity=(500, 0, 0, 0, 0, 0)))
        self.refuse(ValueError, "vx, vy", lambda: ping(POSE, velocity=(1, 2, 3)))
        self.refuse(ValueError, "none beyond 180", lambda: ping(POSE, velocity=[float("nan")] * 6))
        self.refuse(ValueError, "vx, vy", lambda: ping(POSE, velocity="abc"))
        self.refuse(ValueError, "1 to 255", lambda: self.simulator(mask_threshold=0))
        self.refuse(ensonify.ConfigError, "(?i)isa|instruction", lambda: self.simulator(isa="mmx").ping(POSE))

    def test_images(self):
        for function in (ensonify.Filter("median"), lambda image: ensonify.score_image(image, GREY),
                         lambda image: ensonify.score_image(GREY, image),
                         lambda image: ensonify.Mapper([[-1, -1, -1], [1, 1, 1]], 0.1).add(image, self.sonar(), POSE)):
            self.refuse(TypeError, "numpy array, not list", lambda: function(GREY.tolist()))
            self.refuse(TypeError, "numpy array, not NoneType", lambda: function(None))
            self.refuse(TypeError, "dtype .*float64", lambda: function(GREY.astype(float)))
            self.refuse(TypeError, "dtype .*int64", lambda: function(GREY.astype(int)))
            self.refuse(ValueError, "2 dimensions, not 3", lambda: function(GREY[None]))
            self.refuse(ValueError, "C-contiguous; numpy.ascontiguousarray", lambda: function(GREY[::2]))
            self.refuse(ValueError, "C-contiguous", lambda: function(GREY.T))
        self.refuse(ensonify.DataError, "finite", lambda: ensonify.Filter("lee")(numpy.full((8, 8), numpy.nan, "f4")))
        nan = numpy.full(GREY.shape, numpy.nan, "f4")
        self.refuse(ValueError, "finite", lambda: ensonify.score_image(nan, GREY))
        self.refuse(ValueError, "finite", lambda: ensonify.score_image(GREY, nan))
        self.refuse(ValueError, "needs pixels", lambda: ensonify.score_image(GREY[:0].copy(), GREY[:0].copy()))
        self.refuse(ValueError, "needs pixels", lambda: ensonify.save_png(self.folder / "a.png", GREY[:0].copy()))
        for angle in (numpy.nan, numpy.inf):
            self.refuse(ValueError, "finite", lambda angle=angle: ensonify.draw_scene(self.scene(), azimuth_deg=angle))
            self.refuse(ValueError, "finite", lambda angle=angle: ensonify.draw_scene(self.scene(), elevation_deg=angle))
        self.refuse(ValueError, "one size", lambda: ensonify.score_mask(GREY, GREY[:8]))
        self.refuse(ensonify.DataError, "16", lambda: ensonify.Mapper([[-1, -1, -1], [1, 1, 1]], 0.1).add(GREY, self.sonar(), POSE))
        self.refuse(ValueError, "128 bins x 48 beams", lambda: ensonify.fan_view(GREY, self.sonar()))
        self.refuse(TypeError, "uint8 or uint16, not float32", lambda: ensonify.fan_view(GREY.astype("f4"), self.sonar()))
        self.refuse(ValueError, "height, width, 3", lambda: ensonify.save_png(self.folder / "a.png", numpy.zeros((4, 4, 4), "u1")))

    def test_read_only_images_are_read(self):
        image = numpy.random.default_rng(1).integers(0, 255, (32, 32), dtype=numpy.uint8)
        locked = image.copy()
        locked.flags.writeable = False
        self.assertSameBits(ensonify.Filter("lee")(locked), ensonify.Filter("lee")(image))
        self.assertSameBits(locked, image)

    def test_grids(self):
        cells = numpy.zeros((3, 4, 5), numpy.uint8)
        for kind, fragment, arguments in [
                (TypeError, "uint8, not float32", (cells.astype("f4"), [0, 0, 0], 0.1)), (ValueError, "3 dimensions", (cells[0], [0, 0, 0], 0.1)),
                (ValueError, "contiguous", (cells[:, ::2], [0, 0, 0], 0.1)), (ValueError, "three finite", (cells, [0, 0], 0.1)),
                (ValueError, "three finite", (cells, [0, 0, numpy.inf], 0.1)), (ValueError, "above 0", (cells, [0, 0, 0], 0)),
                (ValueError, "above 0", (cells, [0, 0, 0], numpy.nan)), (ValueError, "0 .free., 1", (cells + 3, [0, 0, 0], 0.1)),
                (ValueError, "observable must be 0 or 1", (cells, [0, 0, 0], 0.1, cells + 9)), (ValueError, "shape of occupancy", (cells, [0, 0, 0], 0.1, cells[:1].copy())), (ValueError, "needs cells", (cells[:0].copy(), [0, 0, 0], 0.1))]:
            with self.subTest(fragment):
                self.refuse(kind, fragment, lambda a=arguments: ensonify.Grid(*a))
        for value in (numpy.nan, numpy.inf, -numpy.inf):
            self.refuse(ValueError, "must be finite", lambda v=value: ensonify.Map(numpy.full((3, 4, 5), v, "f4"), [0, 0, 0], 0.1))
        map = ensonify.Map(numpy.zeros((3, 4, 5), "f4"), [0, 0, 0], 0.1)
        map.log_odds[0, 0, 0] = numpy.nan
        self.refuse(ensonify.DataError, "NaN or infinity", lambda: map.save(self.folder / "a.npz"))
        grid = ensonify.Grid(cells, [0, 0, 0], 0.1)
        self.refuse(ensonify.ConfigError, "extension|format", lambda: grid.save(self.folder / "a.xyz"))
        self.refuse(ensonify.DataError, "no such file", lambda: ensonify.Grid.load(self.folder / "none.npz"))
        self.refuse(ensonify.ConfigError, "observable", lambda: ensonify.score_map(ensonify.Map(cells.astype("f4"), [0, 0, 0], 0.1), grid))
        self.refuse(ValueError, r"\[2, 3\]", lambda: ensonify.Mapper([0, 0, 0], 0.1))
        self.refuse(ensonify.ConfigError, "cells", lambda: ensonify.Mapper([[-1e4] * 3, [1e4] * 3], 0.01))
        self.refuse(ensonify.ConfigError, "carve", lambda: ensonify.Mapper([[0] * 3, [1] * 3], 0.1, model="crave"))
        self.refuse(ensonify.ConfigError, "free|negative|below", lambda: ensonify.Mapper([[0] * 3, [1] * 3], 0.1, p_free=0.7))

    def test_unknown_names_get_the_nearest(self):
        for call, nearest in [(lambda: ensonify.Scene("test_tonk"), "test_tank"), (lambda: ensonify.Sonar("oculus_m1200d_hg"), "oculus_m1200d_hf"),
                              (lambda: ensonify.Noise("papre"), "paper"), (lambda: ensonify.Recipe("quik"), "quick"),
                              (lambda: ensonify.Filter("meidan"), "median"), (lambda: ensonify.Filter("lee", windw=5), "window"),
                              (lambda: ensonify.config("scene", "damm"), "dam"),
                              (lambda: ensonify.Noise({"name": "x", "stages": [{"stage": "gaussian_speckle", "sgma": 1}]}), "sigma")]:
            with self.subTest(nearest):
                self.refuse(ensonify.ConfigError, f"['\"]{nearest}['\"]", call)
        self.refuse(ensonify.ConfigError, "scene, sonar", lambda: ensonify.config("sonr", "x"))
        self.refuse(ensonify.ConfigError, "train, test", lambda: ensonify.Recipe(self.recipe()).draw_frame("trian", 0, [0]))
        with self.assertRaises(AttributeError):
            ensonify.Simulater  # noqa: B018

    def test_sources_of_another_kind(self):
        opened = open(self.write("any.txt", "x"))  # noqa: SIM115
        opened.close()
        for source in (5, None, 1.5, ["test_tank"], io.StringIO("x"), opened, b"test_tank"):
            for make in (ensonify.Scene, ensonify.Sonar, ensonify.Noise, ensonify.Recipe):
                with self.subTest(repr(source), make=make.__name__):
                    self.refuse(TypeError, "name, a path or a dict", lambda m=make, s=source: m(s))
        self.refuse(ensonify.ConfigError, "noise: must hold finite numbers", lambda: ensonify.Noise({"name": float("nan")}))
        self.refuse(TypeError, "noise holds a object", lambda: ensonify.Noise({"name": object()}))
        self.refuse(TypeError, "parameters go with", lambda: ensonify.Filter([{"method": "lee"}, {"method": "unsharp"}], window=5))

    def test_places_on_the_disk(self):
        self.refuse(ensonify.DataError, "no dataset.json", lambda: ensonify.open_dataset(self.folder))
        self.refuse(ensonify.DataError, "no such file", lambda: ensonify.Scene(self.folder / "no.obj"))
        self.refuse(ensonify.DiskError, "can not be written", lambda: ensonify.save_png("/proc/a.png", GREY))
        self.assertTrue(issubclass(ensonify.DiskError, OSError))
        self.refuse(TypeError, "incompatible", lambda: ensonify.open_dataset(5))
        broken = self.write("broken.obj", "v 0 0 nan\nf 1 2 3\n")
        self.refuse(ensonify.DataError, "broken.obj", lambda: ensonify.Scene(broken))
        self.assertEqual(sorted(p.name for p in pathlib.Path(self.folder).glob("*.png")), [])

    def test_datasets(self):
        dataset = ensonify.open_dataset(self.generate("set", recipe=self.recipe(train=4, test=2)))
        self.refuse(IndexError, "frames 0 to 3", lambda: dataset.images("train", 4))
        self.refuse(IndexError, "frames 0 to 3", lambda: dataset.info("train", -5))
        self.assertEqual(dataset.info("train", -1), dataset.info("train", 3))
        self.assertSameBits(dataset.images("train", -4)["raw"], dataset.images("train", 0)["raw"])
        self.refuse(ensonify.ConfigError, "train, test", lambda: dataset.images("val", 0))
        self.refuse(ensonify.ConfigError, "raw, clean, mask, labels", lambda: dataset.images("train", 0, ["image"]))
        self.refuse(ensonify.DataError, "truth", lambda: dataset.truth("train", 0))
        (self.folder / "set/train/raw/000002.png").write_bytes(b"no PNG")
        self.refuse(ensonify.DataError, "000002.png", lambda: dataset.images("train", 2))

    def test_exceptions_are_pythons_own(self):
        self.assertTrue(issubclass(ensonify.ConfigError, ValueError))
        self.assertTrue(issubclass(ensonify.DataError, RuntimeError))
        self.assertEqual(ensonify.ConfigError.__module__, "ensonify")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Installs the build into an empty prefix and uses it as a stranger would: find_package, compile, link, run.

The data folder of the source tree can not help: programs find data by their own place or that of the package, and this
test moves the prefix after installing, so that no path which the build knew exists any more.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

arguments = None


def run(*command, **options):
    environment = {k: v for k, v in os.environ.items() if k != "ENSONIFY_DATA"}
    done = subprocess.run([str(c) for c in command], env=environment, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} gave {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_install_"))
        run("cmake", "--install", arguments.build, "--prefix", cls.folder / "first")
        cls.prefix = cls.folder / "moved"
        (cls.folder / "first").rename(cls.prefix)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_the_installed_module_is_imported_and_finds_its_data(self):
        folder = next(self.prefix.rglob("_ensonify*.so")).parent.parent
        self.assertEqual(folder, self.prefix / "lib/python3.11/dist-packages")
        said = run("env", f"PYTHONPATH={folder}", "/usr/bin/python3", "-c", "import ensonify, ensonify.data, ensonify.gym;"
                   "print(ensonify.__file__); print(ensonify.Simulator('test_tank', 'holoocean').ping(ensonify.pose(1, 0, -1.5)))",
                   cwd="/")
        self.assertIn(str(self.prefix), said)
        self.assertIn("ensonify.Ping", said)
        self.assertTrue((folder / "ensonify/_ensonify.pyi").is_file())

    def test_a_consumer_builds_and_pings_against_the_installed_package_alone(self):
        consumer = self.folder / "consumer"
        shutil.copytree(arguments.source / "tests" / "install", consumer)
        build = self.folder / "consumer_build"
        run("cmake", "-S", consumer, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
            "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
        run("cmake", "--build", build)
        compiled = (build / "compile_commands.json").read_text()
        self.assertIn(str(self.prefix / "include"), compiled)
        for stranger in (arguments.source, arguments.build):
            self.assertNotIn(f"{stranger}/", compiled)
        used = (build / "build.ninja").read_text()
        self.assertNotIn(f"{arguments.build}/", used)

        said = dict(line.split(" ", 1) for line in run(build / "consumer", cwd="/").splitlines())
        self.assertEqual(pathlib.Path(said["data"]), self.prefix / "share/ensonify/scenes/library")
        self.assertEqual(float(said["wall_y_m"]), -3.65)
        self.assertEqual(said["image"], "256 512")
        # The installed program takes the same ping.
        run(self.prefix / "bin/ensonify", "ping", "test_tank", "--sonar", "holoocean", "--range-max", 6, "--range-bins", 256,
            "--noise", "none", "--pose", "1 0 -1.5 0 0 -90", "--out", self.folder / "same")
        record = json.loads((self.folder / "same/ping.json").read_text())
        self.assertAlmostEqual(float(said["nearest_m"]), record["nearest_surface_m"], places=4)
        self.assertEqual(int(said["mask"]), round(record["mask_share"] * 256 * 512))
        self.assertGreater(int(said["mask"]), 100)

    def test_no_installed_file_names_the_source_tree(self):
        for file in (self.prefix / "lib").rglob("*.cmake"):
            text = file.read_text()
            self.assertNotIn(f"{arguments.source}/", text, file)
            self.assertNotIn(f"{arguments.build}/", text, file)

    def test_every_header_is_installed_and_no_test(self):
        installed = {str(f.relative_to(self.prefix / "include/ensonify"))
                     for f in (self.prefix / "include/ensonify").rglob("*") if f.is_file()}
        rooms = ("core", "config", "scenes", "sensor_models", "sim", "noise", "filters", "output", "mapping",
                 "evaluation", "generators", "reproduction")
        expected = {str(f.relative_to(arguments.source)) for room in rooms for f in (arguments.source / room).glob("*.hpp")}
        self.assertEqual(installed, expected)

    def test_the_installed_program_finds_its_data(self):
        program = self.prefix / "bin" / "ensonify"
        self.assertIn("test_tank", run(program, "scene", "list", cwd="/"))
        out = self.folder / "ping"
        run(program, "ping", "test_tank", "--sonar", "holoocean", "--range-bins", "64", "--pose", "1 0 -1.5 0 10 0",
            "--out", out, cwd="/")
        self.assertTrue((out / "raw.png").is_file())
        # By a link from elsewhere, too, as package managers of the home folder make.
        link = self.folder / "link"
        link.symlink_to(program)
        self.assertIn("oculus_m1200d_hf", run(link, "sonar", "list", cwd="/"))

    def test_the_installed_program_fails_without_its_data(self):
        """Shows that the tests above can fail: nothing else supplies the data."""
        bare = self.folder / "bare" / "bin"
        bare.mkdir(parents=True)
        shutil.copy(self.prefix / "bin" / "ensonify", bare)
        done = subprocess.run([bare / "ensonify", "scene", "check", "test_tank"], capture_output=True, text=True, cwd="/",
                              env={"PATH": os.environ["PATH"]})
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    arguments, rest = parser.parse_known_args()
    arguments.source = arguments.source.resolve()
    arguments.build = arguments.build.resolve()
    unittest.main(argv=["install_test", *rest], verbosity=2)

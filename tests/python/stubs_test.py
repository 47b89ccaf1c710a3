#!/usr/bin/python3
"""What type checkers and readers are told: stubs of everything, docstrings everywhere, right for mypy."""

import ast
import inspect
import os
import pathlib
import shutil
import subprocess
import unittest

import ensonify
import ensonify.data
import ensonify.gym
from ensonify import _ensonify
from module_test_support import ModuleTest, main

PACKAGE = pathlib.Path(ensonify.__file__).parent

USER = """
import numpy
import numpy.typing
import ensonify

simulator = ensonify.Simulator("test_tank", ensonify.Sonar("holoocean", range_max_m=8.0), noise="paper", mask_threshold=9)
ping = simulator.ping(ensonify.pose(1, 0, -1.5, pitch_deg=10), seed=3, truth=False)
raw: numpy.typing.NDArray[numpy.uint8] = ping.raw
name: str = ping.sonar.name
grid: ensonify.Grid = ensonify.voxelize(simulator.scene)
grid.save("a.npz", slice_z_m=None)
run = ensonify.ClosedLoop("test_tank").explore(lambda look: {"done": True}, steps=2)
end: str = run.end
sample = ensonify.data.EndlessFrames("paper", seed=1).frame(0)
observation, info = ensonify.gym.ExploreEnv("test_tank").reset(seed=1)
"""
WRONG = {
    'ensonify.Simulator("a", "b").pnig(1)': "attr-defined",
    'ensonify.pose(1, 0, "deep")': "arg-type",
    'ensonify.Sonar("a", 5)': "misc",
    'x: int = ensonify.Scene("a").name': "assignment",
    'ensonify.Recipe("paper").make_frame("first")': "arg-type",
}


class Stubs(ModuleTest):
    def mypy(self, code):
        (self.folder / "user.py").write_text(code)
        environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent), "MYPY_CACHE_DIR": str(self.folder / "cache")}
        environment.pop("LD_PRELOAD", None)
        return subprocess.run(["/usr/bin/mypy", "--strict", "user.py"], cwd=self.folder, env=environment, capture_output=True, text=True)

    @unittest.skipUnless(shutil.which("/usr/bin/mypy"), "mypy is not installed")
    def test_mypy_agrees_with_right_use_and_finds_wrong_use(self):
        done = self.mypy(USER)
        self.assertEqual(done.returncode, 0, done.stdout)
        done = self.mypy("import ensonify\n" + "\n".join(WRONG) + "\n")
        for line, (code, kind) in enumerate(WRONG.items(), 2):
            self.assertRegex(done.stdout, rf"user\.py:{line}: error: .*\[{kind}\]", code)

    @unittest.skipUnless(shutil.which("/usr/bin/mypy"), "mypy is not installed")
    def test_the_package_itself_passes_strictly(self):
        done = subprocess.run(["/usr/bin/mypy", "--strict", "-p", "ensonify"], cwd=self.folder, capture_output=True, text=True,
                              env={**{k: v for k, v in os.environ.items() if k != "LD_PRELOAD"}, "MYPYPATH": str(PACKAGE.parent)})
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_stubs_name_what_the_module_has(self):
        tree = ast.parse((PACKAGE / "_ensonify.pyi").read_text())
        stubs = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        real = {name for name, member in vars(_ensonify).items() if inspect.isclass(member) or inspect.isroutine(member)}
        self.assertEqual(set(stubs), real)
        for name, node in stubs.items():
            if isinstance(node, ast.ClassDef) and not issubclass(getattr(_ensonify, name), Exception):
                members = {n.name for n in node.body if isinstance(n, ast.FunctionDef) and not n.name.startswith("_")}
                self.assertEqual(members, {m for m in vars(getattr(_ensonify, name)) if not m.startswith("_")}, name)
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_the_public_names_are_there_and_documented(self):
        self.assertEqual(sorted(ensonify.__all__), ensonify.__all__)
        for name in ensonify.__all__:
            member = getattr(ensonify, name)
            if name != "__version__":
                self.assertGreater(len(member.__doc__ or ""), 20, name)
            if inspect.isclass(member):
                self.assertEqual(member.__module__, "ensonify", name)
                for function, method in vars(member).items():
                    if inspect.isroutine(method) and not function.startswith("_"):
                        text = (method.__func__ if isinstance(method, staticmethod) else method).__doc__
                        self.assertGreater(len(text.partition("\n")[2]), 15, f"{name}.{function}")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""What the build used comes from the packages of scripts/packages.txt: every library that a binary loads and every
header that a source file included belongs to a package of the list or to one that these depend on."""

import argparse
import pathlib
import re
import shutil
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
arguments = None


def output_of(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False).stdout


def read_list():
    groups = {}
    group = None
    for line in (ROOT / "scripts/packages.txt").read_text().splitlines():
        line = line.partition("#")[0].strip()
        if line.startswith("["):
            group = line.strip("[]")
        elif line:
            groups.setdefault(group, []).append(line)
    return groups


class Installed:
    """The dependencies of all installed packages, from dpkg's own records."""

    def __init__(self):
        self.depends = {}
        self.providers = {}
        for line in output_of("dpkg-query", "-W", "-f", "${Package}\t${Pre-Depends}, ${Depends}\t${Provides}\n").splitlines():
            package, depends, provides = line.split("\t")
            self.depends.setdefault(package, set()).update(self.names(depends))
            for virtual in self.names(provides):
                self.providers.setdefault(virtual, set()).add(package)

    @staticmethod
    def names(field):
        return {re.split(r"[ (:]", part.strip())[0] for part in re.split(r"[,|]", field) if part.strip()}

    def closure(self, packages):
        reached = set()
        pending = list(packages)
        while pending:
            package = pending.pop()
            for real in {package} & set(self.depends) | self.providers.get(package, set()):
                if real not in reached:
                    reached.add(real)
                    pending += self.depends[real]
        return reached


def owners(files):
    """Package of each file; files that no package owns are missing."""
    result = {}
    variants = {}
    for file in files:
        real = str(pathlib.Path(file).resolve())
        for v in (file, real, real.removeprefix("/usr"), "/usr" + file):
            variants.setdefault(v, file)
    names = sorted(variants)
    for start in range(0, len(names), 500):
        for line in output_of("dpkg", "-S", *names[start:start + 500]).splitlines():
            packages, _, path = line.rpartition(": ")
            if path in variants and not line.startswith("diversion"):
                result[variants[path]] = packages.split(",")[0].split(":")[0]
    return result


def libraries_of(binary):
    return set(re.findall(r"=> (/\S+)", output_of("ldd", binary)))


@unittest.skipUnless(shutil.which("dpkg-query"), "no dpkg here: the list is of Debian packages")
class PackagesTest(unittest.TestCase):
    def setUp(self):
        self.groups = read_list()
        self.installed = Installed()

    def missing(self, files, packages):
        closure = self.installed.closure(packages)
        return sorted({f"{owner} ({file})" for file, owner in owners(files).items() if owner not in closure})

    def everything(self):
        return [p for group in self.groups.values() for p in group]

    def binaries(self):
        found = [arguments.build / "ensonify"]
        found += [f for folder in ("tests", "bench") for f in (arguments.build / folder).glob("*")
                  if f.is_file() and f.stat().st_mode & 0o111]
        self.assertGreater(len(found), 3)
        return found

    def test_every_library_that_is_loaded_is_brought_in_by_the_list(self):
        files = set().union(*map(libraries_of, self.binaries()))
        self.assertGreater(len(files), 10)
        self.assertEqual(self.missing(files, self.everything()), [])

    def test_every_header_that_is_included_is_brought_in_by_the_list(self):
        deps = output_of("ninja", "-C", arguments.build, "-t", "deps")
        files = {line.strip() for line in deps.splitlines() if line.startswith("    /usr/")}
        self.assertGreater(len(files), 500)
        self.assertEqual(self.missing(files, self.everything()), [])

    def test_every_program_that_is_run_is_brought_in_by_the_list(self):
        sources = [f.read_text() for f in ROOT.glob("*/*.cpp") if f.parent.name not in ("tests", "build", "bench")]
        programs = set().union(*(re.findall(r'run_program\(\{"([^"]+)"', text) for text in sources))
        self.assertIn("gnuplot", programs)
        files = {shutil.which(program) for program in programs}
        self.assertNotIn(None, files)
        self.assertEqual(self.missing(files, self.groups["build"]), [])

    def test_no_package_is_in_two_groups_and_each_says_why(self):
        packages = self.everything()
        self.assertEqual(len(packages), len(set(packages)))
        for line in (ROOT / "scripts/packages.txt").read_text().splitlines():
            if line and line[0] not in "#[":
                self.assertRegex(line, r"^\S+ +# .+")

    def test_a_package_that_is_not_listed_is_found(self):
        """Shows that the tests above can fail."""
        loaded = libraries_of(arguments.build / "ensonify")
        for package, library in (("libembree-dev", "embree"), ("liboctomap-dev", "octomap")):
            without = [p for p in self.groups["build"] if p != package]
            self.assertTrue(any(library in line for line in self.missing(loaded, without)), package)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    arguments, rest = parser.parse_known_args()
    unittest.main(argv=["packages_test", *rest], verbosity=2)

#!/usr/bin/python3
"""scripts/: install asks for nothing but what is missing; all of them work from any folder."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCRIPTS = sorted(f for f in (ROOT / "scripts").iterdir() if f.is_file() and os.access(f, os.X_OK)) + [ROOT / ".ci/run"]


class InstallScript(unittest.TestCase):
    """Against a dpkg-query, an apt-get and a sudo that only write down what they are asked."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ensonify_scripts_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.log = self.folder / "log"
        self.tools = self.folder / "tools"
        self.tools.mkdir()
        for name in ("awk", "dirname", "readlink", "env", "bash"):
            (self.tools / name).symlink_to(shutil.which(name))
        self.tool("apt-get", f'echo "apt-get $*" >>{self.log}')

    def tool(self, name, body):
        path = self.tools / name
        path.write_text(f"#!/bin/bash\n{body}\n")
        path.chmod(0o755)

    def install(self, *groups, missing=(), user=0, sudo=False):
        self.tool("dpkg-query", f'case " {" ".join(missing)} " in *" ${{!#}} "*) exit 1;; *) echo -n installed;; esac')
        self.tool("id", f"echo {user}")
        if sudo:
            self.tool("sudo", f'echo -n "sudo " >>{self.log}; exec "$@"')
        return subprocess.run([ROOT / "scripts/install", *groups], env={"PATH": str(self.tools)}, cwd="/",
                              capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def asked(self):
        return self.log.read_text().splitlines() if self.log.exists() else []

    def test_nothing_missing_asks_for_nothing(self):
        for user in (0, 1000):
            done = self.install("build", "test", "optional", user=user)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertEqual(self.asked(), [])

    def test_only_what_is_missing_is_installed(self):
        self.assertEqual(self.install("build", missing=["libembree-dev", "libgtest-dev"]).returncode, 0)
        self.assertEqual(self.asked()[-1], "apt-get install -y -qq --no-install-recommends libembree-dev")

    def test_a_user_with_sudo_uses_it(self):
        self.assertEqual(self.install(missing=["cmake"], user=1000, sudo=True).returncode, 0)
        self.assertEqual([line.split()[:2] for line in self.asked()], [["sudo", "apt-get"]] * 2)

    def test_a_user_without_sudo_is_told_what_to_ask_for(self):
        done = self.install(missing=["cmake", "libfmt-dev"], user=1000)
        self.assertEqual(done.returncode, 1)
        self.assertIn("neither root nor sudo", done.stderr)
        self.assertIn("apt-get install --no-install-recommends cmake libfmt-dev", done.stderr)
        self.assertEqual(self.asked(), [])

    def test_an_unknown_group_is_refused(self):
        done = self.install("buidl")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no group 'buidl'", done.stderr)

    def test_a_failing_apt_fails(self):
        self.tool("apt-get", "exit 100")
        self.assertNotEqual(self.install(missing=["cmake"]).returncode, 0)


class Manners(unittest.TestCase):
    def test_all_stop_at_the_first_error(self):
        for script in SCRIPTS:
            text = script.read_text()
            if text.startswith("#!/usr/bin/env bash"):
                self.assertIn("\nset -euo pipefail\n", text, script)

    @unittest.skipUnless(shutil.which("shellcheck"), "no shellcheck here")
    def test_shellcheck_finds_nothing(self):
        scripts = [s for s in SCRIPTS if "bash" in s.read_text().splitlines()[0]]
        done = subprocess.run(["shellcheck", *scripts], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)

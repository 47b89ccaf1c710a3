#!/usr/bin/python3
"""Runs what the documents tell people to run: see CONTRIBUTING.md, "Documents are tested"."""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.M | re.S)
KNOWN_KINDS = {"sh", "yaml", "text", "console", "python", "cmake", "cpp", "json"}
# These would build and test from within a test; tests/scripts_test.py and CI run them.
OF_THE_SOURCE_TREE = ("scripts/", "cmake ", "git clone")
arguments = None


def documents():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "ARCHITECTURE.md", *sorted((ROOT / "docs").glob("*.md"))]


def commands_of(block):
    """Lines of a block; one that ends in a backslash goes on in the next."""
    return [line.strip() for line in block.replace("\\\n", " ").splitlines() if line.strip() and not line.startswith("#")]


def examples(text):
    """The files to write and the commands to run of a document, in order: (kind, content) pairs."""
    for kind, block in BLOCK.findall(text):
        if kind == "sh":
            yield from (("run", command) for command in commands_of(block)
                        if not command.startswith(OF_THE_SOURCE_TREE))
        named = re.match(r"# file: (\S+)\n", block)
        if kind in ("yaml", "python") and named:
            yield "write", (named[1], block)
        elif kind == "python":
            yield "python", block


class DocsTest(unittest.TestCase):
    def run_examples(self, text, folder):
        """Failures of the examples, as texts."""
        environment = {k: v for k, v in os.environ.items() if k != "ENSONIFY_DATA"}
        environment["PATH"] = f"{arguments.program.parent}:/usr/bin:/bin"
        shutil.copy(ROOT / "tests/support/cube.obj", folder / "my_mesh.obj")
        failures = []
        for kind, content in examples(text):
            if kind == "write":
                (folder / content[0]).write_text(content[1])
                continue
            command = ["bash", "-euo", "pipefail", "-c", content] if kind == "run" else ["/usr/bin/python3", "-B", "-c", content]
            python = {"PYTHONPATH": str(arguments.program.parent / "python"), **({"LD_PRELOAD": arguments.preload} if arguments.preload else {})}
            done = subprocess.run(command, cwd=folder, env={**environment, **(python if kind == "python" else {})}, text=True,
                                  capture_output=True, stdin=subprocess.DEVNULL, timeout=300 * float(os.environ.get("ENSONIFY_TEST_PATIENCE", 1)))
            if done.returncode != 0:
                failures.append(f"$ {content}\n{done.stdout}{done.stderr}")
        return failures

    def test_the_table_of_instruments_is_made_from_their_files(self):
        table = subprocess.run([arguments.program, "sonar", "list", "--markdown"], capture_output=True, text=True,
                               check=True).stdout
        self.assertIn(table, (ROOT / "docs/instruments.md").read_text())

    def test_the_table_of_filters_is_made_from_their_registry(self):
        table = subprocess.run([arguments.program, "filter", "--list", "--markdown"], capture_output=True, text=True,
                               check=True).stdout
        self.assertIn(table, (ROOT / "docs/filters.md").read_text())

    def test_every_command_in_the_documents_works(self):
        count = 0
        for document in documents():
            text = document.read_text()
            count += sum(kind in ("run", "python") for kind, _ in examples(text))
            with self.subTest(document.name), tempfile.TemporaryDirectory(prefix="ensonify_docs_") as folder:
                self.assertEqual(self.run_examples(text, pathlib.Path(folder)), [])
        self.assertGreater(count, 15)

    def test_a_command_that_does_not_work_is_found(self):
        text = "```sh\nensonify sonar list\nensonify sonar lost\n```\n```python\nimport ensonify\nensonify.Scene\n```\n"
        with tempfile.TemporaryDirectory(prefix="ensonify_docs_") as folder:
            failures = self.run_examples(text, pathlib.Path(folder))
        self.assertEqual(len(failures), 1)
        self.assertIn("sonar lost", failures[0])

    def test_blocks_say_what_they_are(self):
        for document in documents():
            for kind, block in BLOCK.findall(document.read_text()):
                self.assertIn(kind, KNOWN_KINDS, f"{document.name}: {block[:60]}")
                if kind != "sh":
                    self.assertNotRegex(block, r"^\$? ?ensonify ", f"{document.name}: a command outside of a sh block")

    def test_commands_of_the_source_tree_exist(self):
        for document in documents():
            for kind, block in BLOCK.findall(document.read_text()):
                for command in commands_of(block) if kind == "sh" else []:
                    if command.startswith("scripts/"):
                        self.assertTrue(os.access(ROOT / command.split()[0], os.X_OK), command)

    def test_links_lead_somewhere(self):
        for document in documents():
            for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", document.read_text()):
                if not target.startswith("http"):
                    self.assertTrue((document.parent / target).exists(), f"{document.name}: {target}")

    def test_every_bundled_thing_and_every_option_is_named(self):
        together = "\n".join(d.read_text() for d in documents())
        for library in ("scenes", "sensor_models", "noise", "filters", "filters/presets", "filters/tuning", "generators",
                        "reproduction"):
            for file in (ROOT / library / "library").glob("*.yaml"):
                self.assertIn(f"`{file.stem}`", together)
        for command in ("evaluate filters", "evaluate map", "explore", "filter", "generate", "map", "ping", "reproduce", "stats", "voxelize"):
            text = subprocess.run([arguments.program, *command.split(), "--help"], capture_output=True, text=True).stdout
            for option in set(re.findall(r"^  (?:-h,)?(--[a-z-]+)", text, re.M)) - {"--help"}:
                self.assertIn(option, together, command)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--preload", help="library that Python needs before a sanitized module")
    arguments, rest = parser.parse_known_args()
    arguments.program = arguments.program.resolve()
    unittest.main(argv=["docs_test", *rest], verbosity=2)

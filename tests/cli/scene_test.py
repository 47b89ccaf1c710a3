#!/usr/bin/python3
"""What `scene check` reads, refuses and warns of: meshes of every format, and scenes whose truth is void."""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from mesh_files import CUBE_OBJ, WHOLE_MESHES
from support import ProgramTest, SCENE, changed, main


class Meshes(ProgramTest):
    def test_whole_ones_are_read(self):
        for name, data in WHOLE_MESHES.items():
            with self.subTest(name):
                self.write(name, data)
                self.assertIn("valid", self.succeed("scene", "check", name).stdout)

    def test_truncated_and_garbage_ones_are_refused(self):
        for name, data in WHOLE_MESHES.items():
            # Text formats cut anywhere but at the end of a line; .obj has no end mark, so there a face loses its corner.
            cuts = [len(data) // 2 + 1, len(data) * 9 // 10] if not name.endswith(".obj") else []
            bad = {f"cut at {c}": data[:c] for c in cuts}
            bad["one byte"] = data[:1]
            bad["garbage"] = bytes((i * 97 + 13) % 256 for i in range(4000))
            bad["zeros"] = bytes(4000)
            if name.endswith(".obj"):
                bad["face of a missing vertex"] = data + b"f 1 2 99\n"
                bad["vertices alone"] = data[:data.index(b"f ")]
            for what, content in bad.items():
                with self.subTest(f"{name} {what}"):
                    self.write(name, content)
                    done = self.refuse(1, [name], "scene", "check", name)
                    self.assertNotIn("valid\n", done.stdout)

    def test_one_in_millimetres_is_warned_of_and_a_unit_cures_it(self):
        vertices = [f"v {' '.join(str(1000 * float(x)) for x in line.split()[1:])}" if line[0] == "v" else line
                    for line in CUBE_OBJ.splitlines()]
        self.write("mm.obj", "\n".join(vertices))
        done = self.succeed("scene", "check", "mm.obj")
        self.assertIn("warning: mm.obj: 2000 m in its largest extent", done.stderr)
        self.assertIn("unit: mm", done.stderr)
        self.assertIn("unit and scale are keys of an object in a scene YAML", done.stderr)
        self.write("mm.yaml", changed(SCENE, "shape: box\n    length_m: {uniform: [1, 2]}\n    width_m: 1\n    height_m: 2",
                                      "mesh: mm.obj\n    unit: mm"))
        self.assertEqual(self.succeed("scene", "check", "mm.yaml").stderr, "")

    def test_one_that_names_files_elsewhere_reads_none(self):
        secret = self.write("secret.bin", bytes(64))
        (self.folder / "meshes").mkdir()
        for uri in (str(secret), "../secret.bin", "/dev/zero", "/etc/passwd"):
            scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                     "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                     "buffers": [{"byteLength": 36, "uri": uri}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
                     "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}
            self.write("meshes/evil.gltf", json.dumps(scene))
            with self.subTest(uri):
                self.refuse(1, ["evil.gltf"], "scene", "check", "meshes/evil.gltf")


class Void(ProgramTest):
    """Scenes whose truth holds nothing of what they describe are valid, and seldom meant."""

    def check(self, changes, fragments):
        scene = SCENE
        for old, new in changes:
            self.assertIn(old, scene)
            scene = scene.replace(old, new)
        self.write("own_scene.yaml", scene)
        for words in (("scene", "check", "own_scene.yaml"),
                      ("voxelize", "own_scene.yaml", "--resolution", 0.2, "--out", "truth.npz")):
            said = self.succeed(*words).stderr
            for fragment in fragments:
                self.assertIn(f"ensonify: warning: own_scene: {fragment}", said)
            self.assertEqual(said.count("warning"), len(fragments), said)

    def test_of_what_is_no_cell(self):
        alone = ("    on_seabed: true\n", "")
        pose = "pose: {x_m: {uniform: [-1, 1]}}"
        self.check([], [])
        self.check([("depth_m: 4,", "depth_m: 14,"), alone, (pose, "pose: [0, 0, -2]")],
                   ["seabed has no cell in the truth: it lies outside of bounds"])
        self.check([alone, (pose, "pose: [40, 0, -2]")], ["block has no cell in the truth"])
        self.check([alone, (pose, "pose: [0, 0, 3]")], ["block has no cell in the truth"])
        surface = "surface: {roughness_m: 0.03, wavelength_m: 3, spacing_m: 0.5}\n"  # out of the water is no mistake
        self.check([alone, (pose, "pose: [0, 0, 3]"), ("seabed:", surface + "seabed:")], [])
        self.check([("length_m: {uniform: [1, 2]}", "length_m: 11"), ("width_m: 1", "width_m: 11"),
                    ("height_m: 2", "height_m: 3.9"), (SCENE[SCENE.index("waypoints"):], "")],
                   ["navigable, (-5, -5, -3.4) to (5, 5, -0.6) m, has no free cell"])
        self.check([(SCENE[SCENE.index("seabed"):], "surface: {roughness_m: 0.03, wavelength_m: 3, spacing_m: 0.5}\n")], ["nothing in it is an obstacle"])

    def test_of_bundled_places_none(self):
        for name in ("test_tank", "pier_harbor", "boulder_field", "ferry_berth"):  # parts and copies, some out of the water
            self.assertEqual(self.succeed("scene", "check", name).stderr, "")

    def test_of_a_ping_that_meets_nothing(self):
        for pose, reason in (("0 0 2 0 0 0", "it is 2 m above the water (z is up, 0 at the surface)"),
                             ("30 0 -1 0 0 0", "it is outside of the scene, (-"),
                             ("0 0 -1 0 -80 0", "turn it or move it nearer")):
            done = self.succeed("ping", "test_tank", "--sonar", "holoocean", "--pose", pose, "--range-max", "1",
                                "--out", "p")
            self.assertIn("ensonify: warning: test_tank: the sonar at (", done.stderr)
            self.assertIn(f"meets no surface within 0.1 to 1 m: {reason}", done.stderr)
        done = self.succeed("ping", "test_tank", "--sonar", "holoocean", "--pose", "1 0 -1.5 0 10 0", "--out", "p")
        self.assertEqual(done.stderr, "")
        done = self.succeed("ping", "test_tank", "--sonar", "holoocean", "--pose", "1 0 0.5 0 45 10", "--out", "p")
        self.assertIn("is 0.5 m above the water (z is up, 0 at the surface), and pings as if it were in it", done.stderr)

    def test_what_is_watertight_is_said_to_be(self):
        self.write("cube.obj", CUBE_OBJ)
        self.assertIn("watertight", self.succeed("scene", "check", "cube.obj").stdout)
        self.write("open.obj", CUBE_OBJ[:CUBE_OBJ.rindex("f ")])
        self.assertIn("not watertight (4 open edges)", self.succeed("scene", "check", "open.obj").stdout)


if __name__ == "__main__":
    main()

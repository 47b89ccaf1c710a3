#!/usr/bin/python3
"""Meshes made to hurt: each is read or refused within seconds and bounded memory, and none reads what is not its own.
Cuts and flipped bits, by the thousand, are in tests/scenes/mesh_import_test.cpp."""

import base64
import gzip
import json
import pathlib
import struct
import sys
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "cli"))
from mesh_files import CUBE_OBJ, TRIANGLE_DAE, WHOLE_MESHES, cube_ply, cube_stl, triangle_glb  # noqa: E402
from faults import FaultTest  # noqa: E402
from support import main  # noqa: E402

MANY = 1_000_000_000
PLY_BINARY = ("ply\nformat binary_little_endian 1.0\nelement vertex {v}\nproperty float x\nproperty float y\n"
              "property float z\nelement face {f}\nproperty list {n} int vertex_indices\nend_header\n")


def gltf(**changes):
    """A triangle whose buffer lies in triangle.bin; `changes` replace keys at the top."""
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
             "buffers": [{"byteLength": 36, "uri": "triangle.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}
    return json.dumps(scene | changes)


def dae(old, new):
    assert old in TRIANGLE_DAE, old
    return TRIANGLE_DAE.replace(old, new, 1)


def view(**changes):
    return [{"buffer": 0, "byteLength": 36} | changes]


def accessor(**changes):
    return [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"} | changes]


def indexed(indices, **changes):
    packed = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack(f"<{len(indices)}I", *indices)
    uri = "data:application/octet-stream;base64," + base64.b64encode(packed).decode()
    return gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                buffers=[{"byteLength": len(packed), "uri": uri}],
                bufferViews=[{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 4 * len(indices)}],
                accessors=accessor() + [{"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}
                                        | changes])


# Refused: exit code 1.
BROKEN = {
    "nan.obj": "v nan 0 0\nv 1 nan 0\nv 0 0 inf\nf 1 2 3\n",
    "inf.ply": cube_ply().replace("-1 -1 -1", "inf -inf nan").replace("1 -1 -1", "nan 0 0").replace("element face 6", "element face 1"),
    "faceless.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    "beyond.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n",
    "beyond2.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999999\n",
    "below.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4000\n",
    "zero.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 0 0\n",
    "beyond.ply": cube_ply().replace("4 0 3 2 1", "4 0 3 2 1000000000"),
    "below.ply": cube_ply().replace("4 0 3 2 1", "4 0 3 2 -1"),
    "many_vertices.ply": cube_ply().replace("vertex 8", f"vertex {MANY}"),
    "many_faces.ply": cube_ply().replace("face 6", f"face {MANY}"),
    "more_faces.ply": cube_ply().replace("face 6", "face 18446744073709551615"),
    "many_corners.ply": cube_ply().replace("4 0 3 2 1", f"{MANY} 0 3 2 1"),
    "empty_faces.ply": cube_ply().replace("4 0 3 2 1", "0"),
    "binary_many.ply": (PLY_BINARY.format(v=MANY, f=1, n="uchar")).encode() + bytes(100),
    "binary_list.ply": PLY_BINARY.format(v=3, f=1, n="uint").encode() + bytes(36) + struct.pack("<I", 0xFFFFFFFF) + bytes(12),
    "binary_none.ply": PLY_BINARY.format(v=0, f=0, n="uchar").encode(),
    "many.stl": cube_stl()[:80] + struct.pack("<I", MANY) + cube_stl()[84:],
    "most.stl": cube_stl()[:80] + struct.pack("<I", 0xFFFFFFFF) + cube_stl()[84:],
    "none.stl": cube_stl()[:80] + struct.pack("<I", 0),
    "nan.stl": cube_stl()[:84] + struct.pack("<12fH", *[float("nan")] * 12, 0) * 12,
    "count.gltf": gltf(accessors=accessor(count=MANY)),
    "count64.gltf": gltf(accessors=accessor(count=2**62)),
    "negative.gltf": gltf(accessors=accessor(count=-3)),
    "fraction.gltf": gltf(accessors=accessor(count=2.5)),
    "view.gltf": gltf(bufferViews=view(byteLength=MANY)),
    "offset.gltf": gltf(bufferViews=view(byteOffset=2**40)),
    "accessor_offset.gltf": gltf(accessors=accessor(byteOffset=2**33)),
    "stride.gltf": gltf(bufferViews=view(byteStride=2**31)),
    "buffer.gltf": gltf(bufferViews=view(buffer=7)),
    "no_view.gltf": gltf(accessors=accessor(bufferView=9)),
    "wraps.gltf": gltf(bufferViews=view(byteOffset=2**64 - 20)),
    "type.gltf": gltf(accessors=accessor(type="MAT9")),
    "component.gltf": gltf(accessors=accessor(componentType=1)),
    "no_mesh.gltf": gltf(nodes=[{"mesh": 5}]),
    "no_node.gltf": gltf(scenes=[{"nodes": [77]}]),
    "no_accessor.gltf": gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 12}}]}]),
    "cycle.gltf": gltf(nodes=[{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}]),
    "deep.gltf": gltf(nodes=[{"children": [i + 1]} for i in range(100_000)] + [{"mesh": 0}]),
    "index.gltf": indexed([0, 1, 4_000_000_000]),
    "index_count.gltf": indexed([0, 1, 2], count=MANY),
    "matrix.gltf": gltf(nodes=[{"mesh": 0, "matrix": [1e308] * 16}]),
    "types.gltf": gltf(nodes={"a": 1}, meshes="x", accessors=[1, 2], buffers=7),
    "null.gltf": gltf(nodes=[None], meshes=[None], accessors=[None]),
    "sparse.gltf": gltf(accessors=accessor(sparse={"count": MANY, "indices": {"bufferView": 0, "componentType": 5125},
                                                   "values": {"bufferView": 0}})),
    "brackets.gltf": "[" * 1_000_000,
    "http.gltf": gltf(buffers=[{"byteLength": 36, "uri": "http://localhost:9/x.bin"}]),
    "count.dae": dae('count="9"', f'count="{MANY}"'),
    "accessor.dae": dae('count="3" stride="3"', f'count="{MANY}" stride="3"'),
    "stride.dae": dae('stride="3"', 'stride="4294967295"'),
    "triangles.dae": dae('triangles count="1"', f'triangles count="{MANY}"'),
    "index.dae": dae("<p>0 1 2</p>", "<p>0 1 4000000000</p>"),
    "negative.dae": dae("<p>0 1 2</p>", "<p>0 1 -2</p>"),
    "nan.dae": dae("0 0 0 1 0 0 0 1 0", "nan nan nan inf 0 0 0 1 0"),
    "deep.dae": dae('<instance_geometry url="#g"/>', "<node>" * 100_000 + "</node>" * 100_000),
    "entities.dae": '<!DOCTYPE x [<!ENTITY a "' + "x" * 1000 + '">]>' + TRIANGLE_DAE,
    "packed.zae": None, "packed.obj.gz": None,
    "unknown.fbx": "Kaydara FBX Binary  \0",
}

# May be read or refused: what counts is that nothing gives way.
ODD = {
    "line.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n# " + "x" * 20_000_000 + "\nf 1 2 3\n",
    "name.obj": "o " + "n" * 20_000_000 + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "polygon.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf" + " 1 2 3" * 300_000 + "\n",
    "objects.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "o a\nf 1 2 3\n" * 20_000,
    "groups.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "".join(f"usemtl m{i}\nf 1 2 3\n" for i in range(20_000)),
    "backslash.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\",
    "numbers.obj": "v 1e999 -1e999 1e-999\nv 1 0 0\nv 0 1 0\nv " + "9" * 100_000 + " 0 0\nf 1 2 3\nf 2 3 4\n",
    "slashes.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//////2 2/// 3/9/9/9\nf 1/99/99 2/-5/-5 3\n",
    "mtllib.obj": "mtllib ../../../../etc/passwd\nmtllib /dev/zero\n" + CUBE_OBJ,
    "curve.obj": "v 0 0 0\ncurv 0 1 1 1\nsurf 0 1 0 1 1\ncall ../x.obj\ncsh -rm x\n" + CUBE_OBJ,
    "line.stl": "solid " + "x" * 20_000_000 + "\nendsolid\n",
    "line.ply": cube_ply().replace("end_header", "comment " + "x" * 900_000 + "\nend_header"),
    "comments.ply": cube_ply().replace("end_header", "comment x\n" * 90_000 + "end_header"),
    "word.dae": dae("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 0 1 " + "0" * 5_000_000),
    "attribute.dae": dae('name="meter"', 'name="' + "m" * 5_000_000 + '"'),
    "comment.dae": dae("<asset>", "<!--" + "-" * 5_000_000 + "--><asset>"),
    "nodes.gltf": gltf(nodes=[{"mesh": 0, "children": list(range(1, 50_000))}] + [{"mesh": 0}] * 49_999),
    "string.gltf": gltf(asset={"version": "2.0", "generator": "x" * 20_000_000}),
    "text_sizes.gltf": gltf(bufferViews=view(byteLength="36")),
    "extension.gltf": gltf(extensionsRequired=["KHR_draco_mesh_compression"], extensionsUsed=["KHR_draco_mesh_compression"]),
    "skin.gltf": gltf(nodes=[{"mesh": 0, "skin": 3}]),
    "camera.gltf": gltf(nodes=[{"mesh": 0, "camera": 7}]),
    "animation.gltf": gltf(animations=[{"channels": [{"sampler": 9, "target": {"node": 99, "path": "translation"}}],
                                        "samplers": []}]),
}


class Meshes(FaultTest):
    def check(self, name):
        """Whether the mesh is read; else the complaint names it."""
        code, said = self.measured("scene", "check", name)
        self.assertIn(code, (0, 1), f"{name}: {said[:300]}")
        if code == 1:
            self.assertIn(f"ensonify: {name}", said)
            self.assertLess(len(said), 3000, said[:300])
        return code == 0

    def put(self, name, content):
        if content is None:
            pathlib.Path(self.folder / name).write_bytes(gzip.compress(bytes(10_000_000)))
            if name.endswith(".zae"):
                with zipfile.ZipFile(self.folder / name, "w", zipfile.ZIP_DEFLATED) as packed:
                    packed.writestr("a.dae", bytes(10_000_000))
        else:
            self.write(name, content)
        self.write("triangle.bin", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))

    def test_broken_ones_are_refused(self):
        for name, content in BROKEN.items():
            with self.subTest(name):
                self.put(name, content)
                self.assertFalse(self.check(name))

    def test_odd_ones_are_read_or_refused(self):
        for name, content in ODD.items():
            with self.subTest(name):
                self.put(name, content)
                self.check(name)

    def test_files_in_other_codes_are_refused(self):
        for name, content in WHOLE_MESHES.items():
            if isinstance(content, bytes):
                continue
            for code in ("utf-16", "utf-32"):
                with self.subTest(f"{name} {code}"):
                    self.write(name, content.encode(code))
                    self.assertFalse(self.check(name))
            self.write(name, b"\xef\xbb\xbf" + content.encode())
            self.check(name)

    def test_nothing_outside_of_the_folder_is_read(self):
        inside = self.folder / "meshes"
        inside.mkdir()
        self.write("triangle.bin", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        (inside / "link.bin").symlink_to(self.folder / "triangle.bin")
        for uri in ("../triangle.bin", "%2e%2e/triangle.bin", "%2E%2E%2Ftriangle.bin", "..\\triangle.bin",
                    str(self.folder / "triangle.bin"), f"file://{self.folder}/triangle.bin", "link.bin",
                    "sub/../../triangle.bin", "/dev/zero", "/proc/self/mem", "triangle.bin\0.bin"):
            with self.subTest(uri):
                self.write("meshes/a.gltf", gltf(buffers=[{"byteLength": 36, "uri": uri}]))
                self.assertFalse(self.check("meshes/a.gltf"))


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""A mesh of one's own, looked at from all sides: own_mesh.py MESH [FOLDER]

Any .obj, .ply, .stl, .gltf, .glb or .dae is a scene by itself; its frame becomes the world, deep under water.
"""

import math
import pathlib
import sys

import numpy

import ensonify

if len(sys.argv) < 2:
    sys.exit(__doc__)
mesh = sys.argv[1]
out = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "out/own_mesh")
scene = ensonify.Scene(mesh)
low, high = scene.bounds_m
middle, size_m = (low + high) / 2, float(numpy.linalg.norm(high - low))
print(f"{scene}: {size_m:.2f} m from corner to corner")

# A bit farther away than it is large, and 15 degrees above it.
distance_m = max(1.3 * size_m, 1.0)
sonar = ensonify.Sonar("oculus_m1200d_lf", range_max_m=min(1.7 * distance_m, 40), range_bins=512)
simulator = ensonify.Simulator(scene, sonar)
pictures = []
for yaw_deg in range(0, 360, 90):
    back, up = distance_m * math.cos(math.radians(15)), distance_m * math.sin(math.radians(15))
    x = middle[0] - back * math.cos(math.radians(yaw_deg))
    y = middle[1] - back * math.sin(math.radians(yaw_deg))
    ping = simulator.ping(ensonify.pose(x, y, middle[2] + up, pitch_deg=15, yaw_deg=yaw_deg), seed=yaw_deg)
    seen_m = numpy.nanmin(numpy.where(ping.instance == 0, ping.sonar.range_m[:, None], numpy.nan))
    print(f"from yaw {yaw_deg:3d}: nearest echo at {seen_m:.2f} m, {numpy.count_nonzero(ping.mask)} pixels")
    pictures.append(ensonify.fan_view(ping.raw, sonar, 360))
ensonify.save_png(out / "four_sides.png", numpy.ascontiguousarray(numpy.hstack(pictures)))
print(f"picture in {out}")

#!/usr/bin/python3
"""A filter of one's own, scored beside ours on fresh frames: own_filter.py [FRAMES]

Yours is any function from uint8 [bins, beams] to grey levels 0..255.
"""

import sys

import numpy

import ensonify


def running_mean(image):
    """Five bins along range: a stand-in for your own."""
    padded = numpy.pad(image.astype(numpy.float32), ((2, 2), (0, 0)), mode="reflect")
    return sum(padded[k:k + image.shape[0]] for k in range(5)) / 5


recipe = ensonify.Recipe("quick")
frames = [recipe.make_frame(i) for i in range(int(sys.argv[1]) if len(sys.argv) > 1 else 8)]
filters = {"raw": lambda image: image.astype(numpy.float32), "running mean": running_mean,
           "median": ensonify.Filter("median"), "lee": ensonify.Filter("lee", window=7, cu=0.5),
           "wavelet": ensonify.Filter("wavelet")}

print("filter          PSNR     SSIM     mask IoU at its best threshold")
for name, apply in filters.items():
    images = [apply(frame.raw) for frame in frames]
    scores = [ensonify.score_image(image, frame.clean) for image, frame in zip(images, frames)]
    best = max(numpy.mean([ensonify.score_mask(image >= t, frame.mask)["iou"] for image, frame in zip(images, frames)])
               for t in range(4, 128, 8))
    print(f"{name:14s}  {numpy.mean([s['psnr_db'] for s in scores]):5.2f}  {numpy.mean([s['ssim'] for s in scores]):7.4f}  {best:9.3f}")

#!/usr/bin/python3
"""ensonify filter and evaluate filters as a user meets them."""

import csv
import json
import pathlib
import shutil
import subprocess
import unittest

import numpy as np

from support import ProgramTest, main

try:
    from skimage.metrics import structural_similarity
except ImportError:
    structural_similarity = None


def speckled(rows=40, columns=50, seed=1):
    random = np.random.default_rng(seed)
    return np.clip(60 * random.rayleigh(0.8, (rows, columns)), 0, 255).astype(np.float32)

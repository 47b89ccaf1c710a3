#!/usr/bin/python3
"""Data for training: the same frames for the same seed, none twice, in any number of processes, in constant memory."""

import hashlib
import itertools
import os
import pathlib
import pickle
import subprocess
import sys

import numpy

import ensonify
import ensonify.data
from module_test_support import POSE, ModuleTest, main

try:
    import torch.utils.data as torch_data
except ImportError:
    torch_data = None


def digest(array):
    return hashlib.sha256(numpy.ascontiguousarray(array).tobytes()).hexdigest()


def in_child(work):
    """What work() returns in a forked process, as text."""
    here, there = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(there, str(work()).encode())
        finally:
            os._exit(0)
    os.close(there)
    with os.fdopen(here) as answer:
        text = answer.read()
    os.waitpid(child, 0)
    return text


class FromAFolder(ModuleTest):
    def setUp(self):
        super().setUp()
        self.out = self.generate("set", recipe=self.recipe(train=20, test=4))

    def test_samples_are_the_frames(self):
        self.assertEqual(ensonify.data.FrameDataset(self.out, "train", fields="mask").fields, ("mask",))
        frames = ensonify.data.FrameDataset(self.out, "train", fields=("raw", "mask", "labels"))
        dataset = ensonify.open_dataset(self.out)
        self.assertEqual(len(frames), 20)
        for number in (0, 7, 19):
            sample = frames[number]
            self.assertEqual(set(sample), {"raw", "mask", "labels", "pose", "place", "index"})
            for kind in ("raw", "mask", "labels"):
                self.assertSameBits(sample[kind], dataset.images("train", number)[kind])
            self.assertEqual(sample["pose"].shape, (4, 4))
            self.assertEqual(sample["place"], dataset.info("train", number)["place"])
        self.assertSameBits(frames[-1]["raw"], frames[19]["raw"])
        self.assertEqual(sum(1 for _ in frames), 20)

    def test_a_webdataset_holds_the_same(self):
        tar = self.generate("tar", "--format", "webdataset")
        for number in (0, 19):
            self.assertSameBits(ensonify.data.FrameDataset(tar)[number]["raw"], ensonify.data.FrameDataset(self.out)[number]["raw"])

    def test_transform_pickle_and_errors(self):
        frames = ensonify.data.FrameDataset(self.out, transform=lambda sample: sample["raw"].mean())
        self.assertEqual(frames[3], ensonify.data.FrameDataset(self.out)[3]["raw"].mean())
        again = pickle.loads(pickle.dumps(ensonify.data.FrameDataset(self.out)))
        self.assertSameBits(again[4]["raw"], ensonify.data.FrameDataset(self.out)[4]["raw"])
        for kind, call in [(IndexError, lambda: frames[20]), (IndexError, lambda: frames[-21]),
                           (ensonify.ConfigError, lambda: ensonify.data.FrameDataset(self.out, "val")),
                           (ensonify.ConfigError, lambda: ensonify.data.FrameDataset(self.out, fields=("image",)))]:
            with self.assertRaises(kind):
                call()


class WithoutEnd(ModuleTest):
    def frames(self, **options):
        return ensonify.data.EndlessFrames(str(self.recipe()), **options)

    def test_a_frame_follows_from_seed_epoch_rank_and_number(self):
        def of(seed, rank, epoch, k):
            frames = self.frames(seed=seed, rank=rank)
            frames.set_epoch(epoch)
            return digest(frames.frame(k)["raw"])

        addresses = list(itertools.product(range(2), repeat=4))
        first = [of(*a) for a in addresses]
        self.assertEqual(len(set(first)), len(addresses))
        self.assertEqual([of(*a) for a in reversed(addresses)], first[::-1])

    def test_iterating_counts(self):
        frames = self.frames(frames=5)
        self.assertEqual([s["index"] for s in frames], [0, 1, 2, 3, 4])
        self.assertEqual([s["index"] for s in itertools.islice(self.frames(), 7)], list(range(7)))
        self.assertEqual(digest(next(iter(frames))["raw"]), digest(frames.frame(0)["raw"]))

    def test_every_field_and_a_transform(self):
        sample = self.frames(fields=ensonify.data.LAYERS).frame(0)
        self.assertEqual(set(sample), set(ensonify.data.LAYERS) | {"pose", "place", "index"})
        self.assertEqual(self.frames(transform=lambda s: s["index"]).frame(4), 4)
        again = pickle.loads(pickle.dumps(self.frames(seed=2)))
        self.assertSameBits(again.frame(1)["raw"], self.frames(seed=2).frame(1)["raw"])

    def test_wrong_arguments(self):
        for call in (lambda: self.frames(seed=-1), lambda: self.frames(frames=0), lambda: self.frames().set_epoch(-1),
                     lambda: self.frames(split="val"), lambda: self.frames(fields=("image",)),
                     lambda: self.frames(split="test").frame(0)):
            with self.assertRaises(ValueError):
                call()

    def test_works_where_torch_is_not(self):
        code = ("import sys; sys.modules['torch'] = None; import ensonify.data as d; "
                f"print(d.EndlessFrames({str(self.recipe())!r}).frame(0)['raw'].shape)")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.strip()), (0, "(128, 48)"), done.stderr)

    def test_importing_ensonify_does_not_load_torch(self):
        done = subprocess.run([sys.executable, "-c", "import sys, ensonify; print('torch' in sys.modules)"], capture_output=True, text=True)
        self.assertEqual(done.stdout.strip(), "False", done.stderr)


class InTorchsLoader(ModuleTest):
    """Frames of a DataLoader by the number of its workers."""

    def setUp(self):
        super().setUp()
        if torch_data is None:
            self.skipTest("python3-torch is not installed")

    def numbers_and_hashes(self, workers, frames=24, **options):
        data = ensonify.data.EndlessFrames(str(self.recipe()), seed=9, frames=frames, **options)
        loader = torch_data.DataLoader(data, batch_size=4, num_workers=workers)
        return [(int(k), digest(raw.numpy())) for batch in loader for k, raw in zip(batch["index"], batch["raw"])]

    def test_no_frame_twice_and_the_same_for_any_number_of_workers(self):
        alone, two, again, three = (self.numbers_and_hashes(w) for w in (0, 2, 2, 3))
        self.assertEqual(two, again)
        self.assertEqual(sorted(two), alone)
        self.assertEqual(sorted(three), alone)
        self.assertEqual([k for k, _ in alone], list(range(24)))
        self.assertEqual(len({h for _, h in alone}), 24)

    def test_workers_after_the_parent_has_used_its_threads(self):
        before = self.simulator("oculus_tank").ping(POSE).raw
        self.numbers_and_hashes(2, frames=8)
        self.assertSameBits(self.simulator("oculus_tank").ping(POSE).raw, before)

    def test_a_folder_in_shuffled_order(self):
        out = self.generate("set", recipe=self.recipe(train=12, test=2))
        frames = ensonify.data.FrameDataset(out)
        loader = torch_data.DataLoader(frames, batch_size=5, shuffle=True, num_workers=2)
        seen = {int(k): digest(raw.numpy()) for batch in loader for k, raw in zip(batch["index"], batch["raw"])}
        self.assertEqual(seen, {k: digest(frames[k]["raw"]) for k in range(12)})


class Forks(ModuleTest):
    def test_a_child_makes_its_own_device_and_the_same_bits(self):
        simulator = self.simulator("oculus_tank")
        recipe = ensonify.Recipe(self.recipe())
        ours = digest(simulator.ping(POSE).raw), digest(recipe.make_frame(0).raw)
        for _ in range(3):
            self.assertEqual(in_child(lambda: (digest(simulator.ping(POSE).raw), digest(recipe.make_frame(0).raw))), str(ours))
        self.assertEqual(in_child(lambda: in_child(lambda: digest(simulator.ping(POSE).raw))), ours[0])
        self.assertEqual(digest(simulator.ping(POSE).raw), ours[0])

    def test_a_child_runs_the_network_that_its_parent_has_run(self):
        model = pathlib.Path(__file__).parents[1] / "filters/learned/pix2pix.onnx"
        mask = ensonify.Filter("pix2pix", model=str(model))
        image = numpy.random.default_rng(1).uniform(0, 255, (500, 300)).astype(numpy.float32)
        ours = digest(mask(image))
        self.assertEqual(in_child(lambda: digest(mask(image))), ours)
        self.assertEqual(in_child(lambda: in_child(lambda: digest(mask(image)))), ours)
        self.assertEqual(digest(mask(image)), ours)

    def test_the_pool_ends_before_a_fork_and_starts_again(self):
        ensonify.set_threads(2)
        self.simulator("oculus_tank").ping(POSE)
        threads = in_child(lambda: len(os.listdir("/proc/self/task")))
        self.assertEqual(threads, "1")
        self.simulator("oculus_tank").ping(POSE)
        ensonify.set_threads(0)


if __name__ == "__main__":
    main()

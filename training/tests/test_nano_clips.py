import itertools
import os
import tempfile
import unittest

import torch

from limpid_training import tensor_file
from limpid_training.nano import clips, warp

from . import nano_clips


class ReadTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "clips")

    def test_every_layer_comes_back(self):
        nano_clips.make_clips(self.folder, files=1, rows=10, columns=12)
        frames = clips.load(self.folder)
        self.assertEqual([(frame.clip, frame.number) for frame in frames], [("000000", 1), ("000000", 10)])
        layers = nano_clips.make_frame(10, 12, torch.Generator().manual_seed(6))
        for name, channels in clips.LAYERS.items():
            if name != "normal":
                read = frames[0].channels[clips.PLACES[name]]
                self.assertTrue(torch.equal(read, layers[name][:channels].half()), name)
        self.assertEqual(sum(place.stop - place.start for place in clips.PLACES.values()), clips.CHANNELS)

    def test_normals_are_those_that_the_camera_sees(self):
        nano_clips.make_clips(self.folder, files=1, rows=10, columns=12)
        normal = clips.load(self.folder)[0].channels[clips.PLACES["normal"]]
        self.assertEqual(normal[:, 5, 5].tolist(), [0, 0, 1])  # towards the camera
        world = torch.tensor([0.0, -0.6, 0.8])[:, None, None]
        seen = clips.in_view(world, nano_clips.CAMERA)[:, 0, 0]
        self.assertTrue(torch.allclose(seen.float(), torch.tensor([0.6, 0.8, 0.0]), atol=1e-3))

    def test_workers_share_the_files(self):
        nano_clips.make_clips(self.folder, files=3, rows=4, columns=4)
        shares = [[frame.clip for frame in clips.load(self.folder, "cpu", number, 2)] for number in (0, 1)]
        self.assertEqual(shares, [["000000"] * 2 + ["000002"] * 2, ["000001"] * 2])
        with self.assertRaisesRegex(ValueError, "4 processes cannot share 3 files"):
            clips.load(self.folder, "cpu", 0, 4)

    def test_other_files_are_refused(self):
        nano_clips.make_clips(self.folder, files=1, rows=4, columns=4, sequence=False)
        with self.assertRaisesRegex(ValueError, "has stills"):
            clips.load(self.folder)
        path = os.path.join(self.folder, "examples.00000.safetensors")
        tensors, _ = tensor_file.read(path)
        tensors = {name: tensor.clone() for name, tensor in tensors.items() if not name.endswith("10/reference2")}
        tensor_file.write(path, tensors)
        with self.assertRaisesRegex(ValueError, "has no '000000/10/reference2'"):
            clips.read(path)


class CropsTest(unittest.TestCase):
    def test_are_squares_of_the_frames_at_even_pixels(self):
        y, x = torch.meshgrid(torch.arange(20.0), torch.arange(13.0), indexing="ij")
        frames = []
        for clip in range(3):
            layers = torch.zeros(clips.CHANNELS, 20, 13)
            layers[0], layers[1], layers[2] = clip, y, x
            frames.append(clips.Stored(str(clip), 1, layers.half()))
        self.assertEqual(clips.smallest_edge(frames), 13)
        cut = clips.crops([(frame,) for frame in frames], 200, 8, torch.Generator().manual_seed(1))[0].float()
        self.assertEqual(cut.shape, (200, clips.CHANNELS, 8, 8))
        self.assertEqual(set(cut[:, 0, 0, 0].tolist()), {0, 1, 2})
        self.assertEqual(set(cut[:, 1, 0, 0].tolist()), {0, 2, 4, 6, 8, 10, 12})
        self.assertEqual(set(cut[:, 2, 0, 0].tolist()), {0, 2, 4})
        self.assertTrue((cut[:, 1] == cut[:, 1, :1, :1] + y[:8, :8]).all())
        self.assertTrue((cut[:, 2] == cut[:, 2, :1, :1] + x[:8, :8]).all())

    def test_may_be_whole_frames(self):
        frames = [clips.Stored("0", 1, torch.rand(clips.CHANNELS, 9, 9).half())]
        cut = clips.crops([frames], 2, 9, torch.Generator().manual_seed(1))
        self.assertTrue(torch.equal(cut[0, 1], frames[0].channels))

    def test_pairs_are_consecutive_frames_in_the_same_place(self):
        with tempfile.TemporaryDirectory() as folder:
            frames = clips.load(nano_clips.make_clips(os.path.join(folder, "clips"), numbers=(1, 2, 9, 10, 11)))
        pairs = clips.pairs_of(frames)
        self.assertEqual([(first.clip, first.number, second.clip, second.number) for first, second in pairs],
                         [(clip, n, clip, n + 1) for clip in ("000000", "000001") for n in (1, 9, 10)])
        for first, second in pairs:  # marks the pixels
            for image, place in itertools.product((first, second), (0, 1)):
                image.channels[place] = torch.arange(40.0)[:, None] if place else torch.arange(36.0)
        cut = clips.crops(pairs, 20, 8, torch.Generator().manual_seed(1))
        self.assertEqual(cut.shape, (2, 20, clips.CHANNELS, 8, 8))
        self.assertTrue(torch.equal(cut[0, :, :2], cut[1, :, :2]))
        self.assertGreater(len(set(cut[0, :, 0, 0, 0].tolist())), 3)


def normals_of(height):
    """The normals of a surface of this height towards the camera: (batch, 3, rows - 2, columns - 2)."""
    right = height[:, :, 1:-1, 2:] - height[:, :, 1:-1, :-2]
    up = height[:, :, :-2, 1:-1] - height[:, :, 2:, 1:-1]
    normal = torch.cat([-right, -up, torch.ones_like(up)], 1)
    return normal / normal.norm(dim=1, keepdim=True)


class CarriedTest(unittest.TestCase):
    image = torch.arange(2 * 3 * 5 * 7.0).view(2, 3, 5, 7)

    def motion(self, columns, rows):
        return torch.tensor([columns, rows])[None, :, None, None].repeat(2, 1, 5, 7)

    def test_whole_pixels_are_fetched_exactly(self):
        fetched, valid = warp.carried(self.image, self.motion(2.0, -1.0))
        self.assertEqual(valid.shape, (2, 1, 5, 7))
        self.assertTrue(torch.allclose(fetched[:, :, 1:, :5], self.image[:, :, :4, 2:], atol=1e-3))
        self.assertTrue(valid[:, :, 1:, :5].all())

    def test_motion_out_of_the_picture_is_invalid(self):
        _, valid = warp.carried(self.image, self.motion(2.0, -1.0))
        self.assertFalse(valid[:, :, 0].any() or valid[:, :, :, 5:].any())
        _, valid = warp.carried(self.image, self.motion(-0.5, 0.5))
        self.assertFalse(valid[:, :, :, 0].any() or valid[:, :, 4].any())
        self.assertTrue(valid[:, :, :4, 1:].all())

    def test_no_motion_is_invalid(self):
        motion = self.motion(0.0, 0.0)
        motion[0, :, 2, 3] = 65504
        fetched, valid = warp.carried(self.image, motion)
        self.assertEqual((~valid).nonzero().tolist(), [[0, 0, 2, 3]])
        self.assertTrue(torch.isfinite(fetched).all())


class VariedTest(unittest.TestCase):
    def test_normals_still_fit_the_surface(self):
        y, x = torch.meshgrid(torch.arange(12.0), torch.arange(12.0), indexing="ij")
        height = (torch.sin(0.7 * x) + 0.1 * x * y + torch.cos(0.4 * y))[None, None]
        channels = torch.zeros(1, clips.CHANNELS, 12, 12)
        channels[:, clips.PLACES["depth"]] = height
        channels[:, clips.PLACES["normal"], 1:-1, 1:-1] = normals_of(height)
        generator, kinds = torch.Generator().manual_seed(2), set()
        for _ in range(60):
            varied = clips.varied(channels[None], generator)
            depth, normal = varied[:, clips.PLACES["depth"]], varied[:, clips.PLACES["normal"], 1:-1, 1:-1]
            self.assertTrue(torch.allclose(normal, normals_of(depth), atol=1e-5))
            kinds.add(tuple(depth[0, 0, 0, :3].tolist()))
        self.assertEqual(len(kinds), 8, "a square has eight symmetries")

    def test_motion_still_leads_to_the_same_surface(self):
        y, x = torch.meshgrid(torch.arange(12.0), torch.arange(12.0), indexing="ij")
        frames = torch.zeros(2, 1, clips.CHANNELS, 12, 12)
        frames[0, 0, clips.PLACES["roughness"]] = x + 0.1 * y
        frames[1, 0, clips.PLACES["roughness"]] = x + 1.5 + 0.1 * (y - 2)  # where the frame before had it
        frames[1, 0, clips.PLACES["motion"]] = torch.tensor([1.5, -2.0])[:, None, None]
        generator = torch.Generator().manual_seed(2)
        for _ in range(20):
            frame = clips.Frame(clips.varied(frames, generator))
            before, after = frame.roughness.chunk(2)
            fetched, valid = warp.carried(before, frame.motion.chunk(2)[1])
            self.assertEqual(valid.sum().item(), 10 * 10)
            self.assertLess(((fetched - after) * valid).abs().max().item(), 1e-4)

    def test_varied_frames_are_other_views_of_the_same(self):
        channels = nano_clips.make_batch(16, 16)
        # Colours that differ, so that their order matters.
        surface, lamp = torch.tensor([1.0, 0.5, 0.25]), torch.tensor([0.3, 1.0, 0.6])
        for name in clips.LIGHT + ["albedo", "albedoSpecular"]:
            first = clips.PLACES[name].start
            tint = surface * lamp
            if name.startswith("albedo"):
                tint = surface
            elif name.split(".")[0] in clips.SIGNALS:
                tint = lamp
            channels[:, first : first + 3] *= tint[:, None, None]
        before = clips.Frame(channels)
        generator, factors, orders = torch.Generator().manual_seed(4), [], set()
        for _ in range(40):
            after = clips.Frame(clips.varied(channels[None], generator))
            factor = after.deviation.amax((1, 2, 3, 4)) / before.deviation.amax((1, 2, 3, 4))
            factors.append(factor)
            orders.add(tuple(after.albedo[0, 0].mean((1, 2)).argsort().tolist()))
            for name in ("accumulated", "first", "filtered", "past", "svgf"):
                ours, theirs = getattr(after, name), getattr(before, name)
                ratio = ours.flatten(1).sum(1) / theirs.flatten(1).sum(1)
                self.assertTrue(torch.allclose(ratio, factor, rtol=1e-4), name)
            for name in ("albedo", "frames", "roughness", "depth"):
                ratio = getattr(after, name).sum() / getattr(before, name).sum()
                self.assertAlmostEqual(ratio.item(), 1, places=4, msg=name)
            # Light, albedo and references still belong together, pixel by pixel and colour by colour.
            mean = 0.5 * (after.references[0] + after.references[1])
            off = (after.compose(after.filtered / 0.8) - mean)[after.seen.expand_as(mean) > 0].abs().max()
            self.assertLess((off / factor.max()).item(), 0.03)
        self.assertEqual(len(orders), 6)
        factors = torch.stack(factors)
        self.assertTrue((factors > 0.249).all() and (factors < 4.01).all())
        self.assertGreater((factors[:, 0] - factors[:, 1]).abs().max().item(), 1, "each frame has its own")


if __name__ == "__main__":
    unittest.main()

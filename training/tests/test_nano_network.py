import itertools
import math
import unittest

import torch

from limpid_training.nano import clips, features, network

from . import nano_clips

SMALL = network.Shape((8, 16), (0, 1), (3, 3))


class FeaturesTest(unittest.TestCase):
    def test_their_number_and_order(self):
        frame = clips.Frame(nano_clips.make_batch())
        x = features.of_frame(frame)
        self.assertEqual(x.shape, (2, features.COUNT, 32, 32))
        light = frame.filtered[0, 1, :, 9, 7]
        luminance = (light * torch.tensor([0.2126, 0.7152, 0.0722])).sum()
        self.assertAlmostEqual(x[0, 3, 9, 7].item(), 0.2 * math.log2(luminance + 0.01), places=5)
        self.assertTrue(torch.equal(x[:, 14:17], frame.albedo[:, 0]))
        self.assertTrue(torch.equal(x[:, 18:21], frame.normal))
        self.assertTrue(torch.equal(x[:, 23:], frame.roughness))

    def test_bend_is_that_of_the_four_neighbours(self):
        plane = (3 * torch.arange(6.0)[:, None] + torch.arange(5.0))[None, None] * 0.1
        bent = features.bend(plane)
        self.assertLess(bent[:, :, 1:-1, 1:-1].abs().max().item(), 1e-6)
        plane[0, 0, 2, 2] += 0.2
        bent = features.bend(plane)[0, 0]
        for at, expected in ((2, 2), 0.8), ((2, 1), -0.2), ((3, 2), -0.2), ((3, 3), 0), ((0, 2), -0.3), ((0, 0), -0.4):
            self.assertAlmostEqual(bent[at].item(), expected, places=5, msg=str(at))

    def test_black_and_bright_frames_have_finite_features(self):
        for value in 0.0, 65504.0:
            frame = clips.Frame(torch.full((1, clips.CHANNELS, 4, 4), value))
            self.assertTrue(torch.isfinite(features.of_frame(frame)).all())


def softmax_mean(taps):
    """The mean of (logit, light, seen) over the taps that are seen; 0 if none is."""
    taps = [(math.exp(logit), light) for logit, light, seen in taps if seen]
    total = sum(weight for weight, _ in taps)
    return sum(weight * light for weight, light in taps) / total if taps else 0.0


def naive(logits, accumulated, svgf, seen, kernel):
    """network.apply() with two levels, number by number. For one signal and one channel: lists of lists."""
    rows, columns = len(seen), len(seen[0])
    inside = lambda y, x, rows, columns: (min(max(y, 0), rows - 1), min(max(x, 0), columns - 1))
    fine, coarse = logits
    half, seen_half = {}, {}
    for y, x in itertools.product(range(rows // 2), range(columns // 2)):
        four = [(2 * y + j, 2 * x + i) for j in (0, 1) for i in (0, 1)]
        half[y, x] = softmax_mean([(min(max(fine[-1][b][a], -10), 10), accumulated[b][a], seen[b][a]) for b, a in four])
        seen_half[y, x] = any(seen[b][a] for b, a in four)
    filtered, seen_filtered = {}, {}
    for y, x in half:
        taps = []
        for k in range(9):
            at = inside(y + k // 3 - 1, x + k % 3 - 1, rows // 2, columns // 2)
            taps.append((coarse[k][y][x], half[at], seen_half[at]))
        filtered[y, x], seen_filtered[y, x] = softmax_mean(taps), any(tap[2] for tap in taps)
    result = [[0.0] * columns for _ in range(rows)]
    for y, x in itertools.product(range(rows), range(columns)):
        taps = []
        for k in range(kernel * kernel):
            b, a = inside(y + k // kernel - kernel // 2, x + k % kernel - kernel // 2, rows, columns)
            taps.append((fine[k][y][x], accumulated[b][a], seen[b][a]))
        for k in range(4):
            at = inside(y // 2 - 1 + y % 2 + k // 2, x // 2 - 1 + x % 2 + k % 2, rows // 2, columns // 2)
            taps.append((fine[kernel * kernel + k][y][x], filtered[at], seen_filtered[at]))
        own = softmax_mean(taps)
        share = 1 / (1 + math.exp(fine[-2][y][x] - fine[-3][y][x]))
        result[y][x] = svgf[y][x] + share * (own - svgf[y][x])
    return result


class ApplyTest(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(1)

    def test_is_the_filter_of_a_naive_loop(self):
        net = network.Net(network.Shape((8, 8), (0, 0), (5, 3)))
        rows, columns = 8, 10
        logits = [3 * torch.randn(1, 2 * net.logits(i), rows >> i, columns >> i, dtype=torch.float64) for i in (0, 1)]
        logits[0][0, -1, 2, 2] = 20.0  # beyond the limit
        accumulated, svgf = torch.rand(2, 1, 2, 3, rows, columns, dtype=torch.float64)
        seen = (torch.rand(1, 1, rows, columns) < 0.6).double()
        seen[0, 0, :4, :4] = 0.0
        result = network.apply(net, logits, accumulated, svgf, seen).light
        flags = (seen[0, 0] > 0).tolist()
        for signal, channel in itertools.product(range(2), range(3)):
            of_signal = [each[0].chunk(2)[signal].tolist() for each in logits]
            expected = naive(of_signal, accumulated[0, signal, channel].tolist(), svgf[0, signal, channel].tolist(),
                             flags, 5)
            self.assertTrue(torch.allclose(result[0, signal, channel], torch.tensor(expected, dtype=torch.float64),
                                           atol=1e-9))

    def test_the_only_tap_that_is_seen_counts_however_small_its_weight(self):
        logits = torch.zeros(1, 1, 9, 1, 1)
        logits[0, 0, 4] = 500.0
        seen = torch.zeros(1, 1, 9, 1, 1)
        self.assertEqual(network.softmax(logits, seen).abs().max().item(), 0)
        seen[0, 0, 2] = 1.0
        self.assertEqual(network.softmax(logits, seen)[0, 0, :, 0, 0].tolist(), [0, 0, 1, 0, 0, 0, 0, 0, 0])

    def test_constant_light_stays(self):
        net = network.Net()
        light = torch.full((1, 2, 3, 32, 32), 0.25)
        logits = [4 * torch.randn(1, 2 * net.logits(i), 32 >> i, 32 >> i) for i in range(5)]
        result = network.apply(net, logits, light, light, torch.ones(1, 1, 32, 32))
        self.assertTrue(torch.allclose(result.light, light, atol=1e-6))

    def test_the_gradient_reaches_every_weight(self):
        net = network.Net(SMALL)
        frame = clips.Frame(nano_clips.make_batch())
        network.denoise(net, frame).light.square().sum().backward()
        for name, weight in net.named_parameters():
            self.assertGreater(weight.grad.abs().max().item(), 0, name)


class NetTest(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(2)

    def test_is_the_one_that_the_library_computes(self):
        for name, multiplications, weights in ("nano", 17588.5, 328710), ("film", 168385, 1781446):
            net = network.Net(network.SHAPES[name])
            self.assertEqual(network.name_of(net.shape), name)
            self.assertEqual([net.logits(level) for level in range(5)], [32, 14, 14, 14, 9])
            self.assertEqual(net.multiplications(), multiplications)
            self.assertEqual(sum(weight.numel() for weight in net.parameters()), weights)
        self.assertIsNone(network.name_of(SMALL))

    def test_begins_with_svgf(self):
        share = network.denoise(network.Net(), clips.Frame(nano_clips.make_batch())).share
        self.assertTrue(((share > 0.15) & (share < 0.4)).all())

    def test_its_shape_is_known_from_its_weights(self):
        for shape in *network.SHAPES.values(), SMALL, network.Shape((8, 8, 24), (2, 0, 1), (7, 5, 3)):
            net = network.Net(shape)
            self.assertEqual(network.shape_of(net.state_dict()), shape)
            again = network.network_of(net.state_dict())
            self.assertTrue(all(torch.equal(a, b) for a, b in zip(net.parameters(), again.parameters())))

    def test_pictures_of_any_size(self):
        net = network.Net()
        for rows, columns in (1, 1), (2, 31), (16, 16), (17, 15), (33, 48):
            frame = clips.Frame(nano_clips.make_batch(rows, columns, count=1))
            with torch.no_grad():
                result = network.denoise(net, frame)
            self.assertEqual(result.light.shape, (1, 2, 3, rows, columns))
            self.assertEqual(result.share.shape, (1, 2, 1, rows, columns))
            self.assertTrue(torch.isfinite(result.light).all())

    def test_pixels_beyond_the_edges_are_those_at_the_edges(self):
        net = network.Net(SMALL)
        frame = clips.Frame(nano_clips.make_batch(6, 7, count=1))
        y, x = torch.arange(6), torch.arange(8).clamp(max=6)

        def wider(image):
            return image[..., y, :][..., x]

        with torch.no_grad():
            logits = net(wider(features.of_frame(frame)))
            expected = network.apply(net, logits, wider(frame.accumulated), wider(frame.filtered), wider(frame.seen))
            self.assertTrue(torch.equal(network.denoise(net, frame).light, expected.light[..., :7]))


if __name__ == "__main__":
    unittest.main()

import math
import unittest

import torch

from limpid_training import features
from limpid_training.network import Kpcn, KernelPredictor, apply_kernel


def random_frame(rows=24, columns=20, batch=2):
    def image(channels):
        return torch.rand(batch, channels, rows, columns)

    frame = {"diffuse": image(3), "specular": 4 * image(3), "albedo": image(3), "normal": 2 * image(3) - 1}
    frame["depth"] = 10 * image(1)
    for name in list(frame):
        frame[name + ".variance"] = 0.1 * image(1)
    return frame


class FeaturesTest(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(1)

    def test_light_comes_back(self):
        frame = random_frame()
        for side in features.SIDES:
            there = features.to_network(side, frame[side], frame["albedo"])
            back = features.from_network(side, there, frame["albedo"])
            self.assertTrue(torch.allclose(back, frame[side], atol=1e-5))

    def test_gradients_of_a_ramp(self):
        rows, columns = torch.meshgrid(torch.arange(4.0), torch.arange(5.0), indexing="ij")
        across, down = features.gradients((3 * columns + 7 * rows)[None, None])[0]
        self.assertTrue(torch.equal(across[:, 1:], torch.full((4, 4), 3.0)))
        self.assertTrue(torch.equal(down[1:, :], torch.full((3, 5), 7.0)))
        self.assertEqual(across[:, 0].abs().sum() + down[0].abs().sum(), 0)

    def test_variance_is_transformed_as_the_light_is(self):
        # Compares with the variance of many transformed samples of one grey pixel.
        samples = 2.0 + 0.05 * torch.randn(200000)
        albedo = torch.full((1, 3, 1, 1), 0.3)
        frame = {"albedo": albedo}
        for side in features.SIDES:
            light = samples.reshape(-1, 1, 1, 1).expand(-1, 3, 1, 1)
            frame[side] = torch.full((1, 3, 1, 1), 2.0)
            frame[side + ".variance"] = samples.var().reshape(1, 1, 1, 1)
            frame["albedo"] = albedo
            truth = features.seen(side, dict(frame, **{side: light}))[0][:, 0].var().item()
            self.assertAlmostEqual(features.seen(side, frame)[1].item() / truth, 1.0, delta=0.02)

    def test_inputs(self):
        frame = random_frame()
        for side in features.SIDES:
            x = features.inputs(side, frame)
            self.assertEqual(x.shape, (2, features.INPUT_CHANNELS, 24, 20))
            light = features.to_network(side, frame[side], frame["albedo"])
            expected = torch.log1p(light) if side == "diffuse" else light
            self.assertTrue(torch.allclose(x[:, :3], expected, rtol=1e-6))
            self.assertEqual(x[:, 30].amax(dim=(1, 2)).tolist(), [1.0, 1.0], "depth over the frame's maximum")

    def test_halves_hold_the_brightest_light_on_the_darkest_surface(self):
        frame = {name: 65504.0 * torch.ones_like(image) for name, image in random_frame().items()}
        frame["albedo"] = torch.zeros_like(frame["albedo"])
        for name in ("albedo", "normal", "depth"):
            frame[name + ".variance"] = torch.ones_like(frame[name + ".variance"])
        for side in features.SIDES:
            frame[side + ".variance"] = frame[side].mean(dim=1, keepdim=True) ** 2  # one sample has all the light
            self.assertLess(features.seen(side, frame)[0].max().item(), 20.0)
            self.assertLessEqual(features.seen(side, frame)[1].max().item(), 1.0)

    def test_linear_diffuse_input(self):
        frame = random_frame()
        light, variance = features.seen("diffuse", frame, "linear")
        self.assertTrue(torch.allclose(light, features.to_network("diffuse", frame["diffuse"], frame["albedo"])))
        divisor = (features.luminance(frame["albedo"]) + features.EPSILON) ** 2
        self.assertTrue(torch.allclose(variance, frame["diffuse.variance"] / divisor))
        logarithmic, linear = Kpcn(1, 4, 3).prepare(frame), Kpcn(1, 4, 3, diffuse_input="linear").prepare(frame)
        for name, image in logarithmic.items():  # only that input differs
            self.assertEqual(torch.equal(image, linear[name]), name != "diffuse.input", name)
        frame["diffuse"] = torch.full_like(frame["diffuse"], 6e4)
        frame["diffuse.variance"] = torch.full_like(frame["diffuse.variance"], 6e4)
        frame["albedo"] = torch.zeros_like(frame["albedo"])
        for image in features.seen("diffuse", frame, "linear"):
            self.assertEqual(image.max().item(), features.MAX_HALF)

    def test_a_network_of_gradients_sees_nothing_else_of_its_guides(self):
        net = KernelPredictor(hidden=1, channels=4, width=3, inputs="gradients")
        x = torch.rand(1, features.INPUT_CHANNELS, 8, 8)
        raised = x.clone()
        raised[:, [10, 11, 12, 19, 20, 22, 29, 30, 33]] += 1.0  # albedo, normal, depth, and their variances
        self.assertTrue(torch.equal(net(x), net(raised)))
        raised[:, 13] += 1.0  # a gradient of albedo
        self.assertFalse(torch.equal(net(x), net(raised)))

    def test_nothing_seen(self):
        frame = {name: torch.zeros_like(image) for name, image in random_frame().items()}
        for side in features.SIDES:
            self.assertTrue(torch.isfinite(features.inputs(side, frame)).all())


def alike_normals(a, b):
    """The condition on normals as docs/kpcn.md states it."""
    lengths = math.hypot(*a) * math.hypot(*b)
    return sum(p * q for p, q in zip(a, b)) >= 0.5 * lengths if lengths > 0 else math.hypot(*a) == math.hypot(*b)


def one_wall(light):
    """Returns features.faces() of a picture whose normals are all equal."""
    return features.faces(torch.ones_like(light[:, :1]).expand(-1, 3, -1, -1))


class KernelTest(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(2)

    def test_is_the_weighted_mean_of_the_formula(self):
        width, rows, columns = 5, 6, 4
        logits = 3 * torch.randn(1, width * width, rows, columns, dtype=torch.float64)
        light = torch.rand(1, 3, rows, columns, dtype=torch.float64)
        normal = torch.randn(1, 3, rows, columns, dtype=torch.float64)
        normal[:, :, 1:3, 2:] = 0.0
        result = apply_kernel(logits, light, features.faces(normal))
        at = [[normal[0, :, y, x].tolist() for x in range(columns)] for y in range(rows)]
        alike = [[[[alike_normals(a, b) for b in line] for line in at] for a in own] for own in at]
        taken = refused = 0
        for row in range(rows):
            for column in range(columns):
                total, weights = torch.zeros(3, dtype=torch.float64), 0.0
                for tap in range(width * width):
                    y, x = row + tap // width - 2, column + tap % width - 2
                    inside = 0 <= y < rows and 0 <= x < columns
                    if inside and not alike[row][column][y][x]:
                        refused += 1
                    elif inside:
                        taken += 1
                        weight = math.exp(logits[0, tap, row, column])
                        total += weight * light[0, :, y, x]
                        weights += weight
                self.assertTrue(torch.allclose(result[0, :, row, column], total / weights, atol=1e-12))
        self.assertGreater(taken, 2 * rows * columns)
        self.assertGreater(refused, 2 * rows * columns)

    def test_weights_beyond_any_exponent(self):
        logits = torch.full((1, 9, 3, 3), -1000.0)
        logits[:, 0] = 1000.0  # the upper left tap: outside the picture for the first row and column
        light = torch.arange(9.0).reshape(1, 1, 3, 3)
        result = apply_kernel(logits, light, one_wall(light))[0, 0]
        self.assertTrue(torch.equal(result[1:, 1:], light[0, 0, :2, :2]))
        self.assertTrue(torch.isfinite(result).all())

    def test_a_constant_picture_stays(self):
        light = torch.full((1, 3, 9, 7), 0.25)
        self.assertTrue(torch.allclose(apply_kernel(5 * torch.randn(1, 49, 9, 7), light, one_wall(light)), light))

    def test_gradient_reaches_every_weight(self):
        logits = torch.randn(1, 9, 4, 4, requires_grad=True)
        light = torch.rand(1, 3, 4, 4)
        apply_kernel(logits, light, one_wall(light)).sum().backward()
        self.assertTrue((logits.grad[:, :, 1:3, 1:3] != 0).all())


class NetworkTest(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(3)

    def test_is_the_published_one(self):
        net = KernelPredictor()
        self.assertEqual(len(net.hidden), 8)
        shapes = [tuple(layer.weight.shape) for layer in [*net.hidden, net.output]]
        self.assertEqual(shapes, [(100, 34, 5, 5)] + 7 * [(100, 100, 5, 5)] + [(441, 100, 5, 5)])

    def test_even_kernels_have_no_centre(self):
        with self.assertRaises(ValueError):
            KernelPredictor(width=4)

    def test_learns(self):
        net = Kpcn(hidden=1, channels=8, width=5)
        frame = random_frame()
        frame["diffuse"] = frame["albedo"] * 0.5 + 0.2 * torch.rand_like(frame["albedo"])
        target = frame["albedo"] * 0.6 + torch.full_like(frame["albedo"], 2.0)
        prepared = features.prepare(frame)
        optimizer = torch.optim.Adam(net.parameters(), lr=1e-2)
        losses = []
        for _ in range(30):
            optimizer.zero_grad()
            loss = (net(prepared) - target).abs().mean()
            loss.backward()
            optimizer.step()
            losses.append(loss.item())
        self.assertLess(losses[-1], 0.8 * losses[0])


if __name__ == "__main__":
    unittest.main()

import math
import unittest

import torch

from limpid_training.nano import clips, evaluate, loss, network

from . import nano_clips


def frame_with(references, svgf):
    frame = clips.Frame(nano_clips.make_batch(*svgf.shape[2:], count=len(svgf)))
    frame.references, frame.svgf = references, svgf
    return frame


class WeightsTest(unittest.TestCase):
    def test_slope_is_that_of_srgb(self):
        light = torch.linspace(0.01, 0.99, 50, dtype=torch.float64).requires_grad_()
        (derivative,) = torch.autograd.grad(loss.srgb(light).sum(), light)
        self.assertTrue(torch.allclose(loss.slope(light), derivative, rtol=1e-3))
        bright = loss.slope(torch.tensor([0.0, 0.001, 1.0, 2.0, 100.0]))
        self.assertEqual(bright[0], bright[1])
        self.assertAlmostEqual((bright[2] / bright[3]).item(), 4, places=5)
        self.assertGreater(bright[4], 0)

    def test_do_not_depend_on_references(self):
        frame = clips.Frame(nano_clips.make_batch())
        before = loss.weights_of(frame)
        frame.references = tuple(torch.rand_like(image) for image in frame.references)
        self.assertTrue(torch.equal(loss.weights_of(frame), before))

    def test_relative_differences_are_like_those_of_relmse(self):
        grey = torch.full((1, 3, 8, 8), 2.0)
        frame = frame_with((grey, grey), grey)
        self.assertTrue(torch.equal(loss.weights_of(frame, 0.0), loss.weights_of(frame)))
        # The square of a sum of errors is that of sRGB's plus relMSE's.
        more = loss.weights_of(frame, 0.5) ** 2 - loss.weights_of(frame) ** 2
        self.assertTrue(torch.allclose(more, torch.full_like(more, 0.25 / (2.0**2 + 0.01)), rtol=1e-4))
        both = loss.Judge(frame, 0.5).loss(grey + 0.01).item() / loss.Judge(frame).loss(grey + 0.01).item()
        self.assertAlmostEqual(both, (loss.weights_of(frame, 0.5) / loss.weights_of(frame)).mean().item() ** 2, places=3)


class ErrorTest(unittest.TestCase):
    """References have skewed noise that is as large as the error, as few samples of a path tracer have."""

    def setUp(self):
        self.generator = torch.Generator().manual_seed(7)
        self.truth = 0.4 + 0.2 * torch.rand(1, 3, 200, 200, generator=self.generator)
        self.picture = self.truth + 0.01 * torch.randn(self.truth.shape, generator=self.generator)

    def noisy(self):
        """The truth plus noise of mean 0 and deviation 0.03: many numbers a little lower, few much higher."""
        return self.truth - 0.03 * (1 + torch.rand(self.truth.shape, generator=self.generator).clamp(min=1e-6).log())

    def test_two_references_give_the_error_without_their_noise(self):
        weights = loss.slope(self.truth)
        true = ((self.picture - self.truth) * weights).square().mean().item()
        references = self.noisy(), self.noisy()
        products = loss.product(self.picture, references, weights)
        spread = products.std().item() / math.sqrt(products.numel())
        self.assertLess(spread, 0.03 * true, "else the test says little")
        self.assertLess(abs(products.mean().item() - true), 4 * spread)
        one = ((self.picture - references[0]) * weights).square().mean().item()
        mean = ((self.picture - sum(references) / 2) * weights).square().mean().item()
        self.assertGreater(one, 8 * true, "one reference adds its noise")
        self.assertGreater(mean, 4 * true, "and so does the mean of both")

    def test_the_error_of_a_perfect_picture_is_nothing(self):
        products = loss.product(self.truth, (self.noisy(), self.noisy()), torch.ones(1))
        self.assertLess(abs(products.mean().item()), 4 * products.std().item() / math.sqrt(products.numel()))

    def test_noisy_references_do_not_move_the_minimum(self):
        frame = frame_with((self.noisy(), self.noisy()), self.truth)
        clean = frame_with((self.truth, self.truth), self.truth)
        for name, error in (("ours", lambda judge, x: judge.loss(x)),
                            ("absolute", lambda judge, x: (x - judge.references[0]).abs().mean())):
            off = {}
            for kind, judge in ("noisy", loss.Judge(frame)), ("shifted", loss.Judge(clean)):
                shift = torch.tensor(0.0 if kind == "noisy" else 0.003, requires_grad=True)
                (off[kind],) = torch.autograd.grad(error(judge, self.truth + shift) / judge.scale.mean(), shift)
            share = (off["noisy"] / off["shifted"]).abs().item()
            if name == "ours":
                self.assertLess(share, 0.15, "of the gradient of an error of 0.003")
            else:
                self.assertGreater(share, 0.2, "a mean of absolute differences leads to the median")

    def test_frames_count_alike_however_wrong_svgf_is(self):
        off = torch.tensor([0.15, 0.5])[:, None, None, None]
        truth = torch.full((2, 3, 24, 24), 0.5)
        svgf = truth * (1 - off)
        judge = loss.Judge(frame_with((truth, truth), svgf))
        each = loss.product(svgf, judge.references, judge.weights).mean((1, 2, 3)) * judge.scale.flatten()
        self.assertGreater(each.min().item(), 0.9)
        self.assertLessEqual(each.max().item(), 1)
        self.assertAlmostEqual(judge.error(svgf).item(), each.mean().item(), places=5)

    def test_a_change_is_that_of_the_error_along_the_surface(self):
        frame = clips.Frame(torch.cat([nano_clips.make_batch(12, 12), nano_clips.make_batch(12, 12)]))
        frame.motion = torch.tensor([2.0, -1.0])[None, :, None, None].expand(4, 2, 12, 12)
        frame.frames = torch.full((4, 2, 12, 12), 5.0)
        frame.frames[3, 1, :, 5] = 1  # has just appeared
        frame.svgf = torch.full((4, 3, 12, 12), 0.5)
        truth = torch.rand(4, 3, 12, 12)
        frame.references = (truth, truth)
        judge = loss.Judge(frame)
        error = 0.02 * torch.rand(4, 3, 12, 12)
        error[2:, :, 1:, :10] = error[:2, :, :11, 2:]  # moves along
        self.assertLess(judge.change(truth + error).item(), 1e-12)
        error[2, :, 4, 4] += 0.01
        error[3, :, 4, 5] += 0.01
        weight = judge.weights[2, :, 4, 4] * 0.01
        expected = 0.5 * weight.square().sum() * loss.SCALE * judge.scale[2].item() / (2 * 3 * 12 * 12)
        self.assertAlmostEqual(judge.change(truth + error).item() / expected.item(), 1, places=3)


class EvaluateTest(unittest.TestCase):
    def test_what_is_svgf_has_its_errors(self):
        stored = [clips.Stored(f"{clip:06}", number, nano_clips.make_batch(24, 20, 1, 3 * clip + number)[0].half())
                  for clip in range(2) for number in (1, 3)]
        net = network.Net(network.Shape((8, 8), (0, 0), (3, 3)))
        with torch.no_grad():
            net.heads[0].bias.view(2, -1)[:, net.kernel_logits(0) + 1] = 1e4  # SVGF's share is 1
        results = evaluate.evaluate(net, stored)
        self.assertEqual([(result["clip"], result["frame"]) for result in results],
                         [("000000", 1), ("000000", 3), ("000001", 1), ("000001", 3)])
        for error, ratio in evaluate.ratios(results).items():
            self.assertAlmostEqual(ratio, 1, places=2, msg=error)
        self.assertIn("square", evaluate.line(results))
        self.assertEqual(list(evaluate.by(results, "frame")), [1, 3])

    def test_errors_are_the_formulas(self):
        frame = clips.Frame(nano_clips.make_batch(16, 16, count=1))
        mean = 0.5 * (frame.references[0] + frame.references[1])
        frame.references = (mean, mean)
        errors = evaluate.errors_of(mean + 0.1, frame)
        weights = loss.weights_of(frame)
        self.assertAlmostEqual(errors["square"], (0.01 * weights**2).mean().item(), places=5)
        self.assertAlmostEqual(errors["blurred"], (0.1 * weights).mean().item(), places=5)
        self.assertTrue(all(value == 0 for value in evaluate.errors_of(mean, frame).values()))


if __name__ == "__main__":
    unittest.main()

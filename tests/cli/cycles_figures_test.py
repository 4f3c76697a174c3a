"""What scripts/cycles does without Blender: figures, and the picture of all scenes."""

import os
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "cycles"))

import figures  # noqa: E402
import sheet  # noqa: E402

TRUTH = numpy.linspace(0.2, 2.0, 16 * 20 * 3).reshape(16, 20, 3)


def pair(random, mean, deviation):
    return [mean + random.normal(0, deviation, mean.shape) for _ in range(2)]


class FiguresTest(unittest.TestCase):
    def test_a_brighter_picture_is_found_where_it_is(self):
        brighter = TRUTH.copy()
        brighter[:, 5:10] *= 1.1
        ratios = figures.strip_ratios([brighter] * 2, [TRUTH] * 2, 4)
        for found, expected in zip(ratios, (1, 1.1, 1, 1)):
            self.assertAlmostEqual(found.value, expected)
            self.assertEqual(found.error, 0)
        self.assertEqual([r.deviates() for r in ratios], [False, True, False, False])

    def test_the_standard_error_is_the_spread_over_seeds(self):
        random = numpy.random.default_rng(1)
        drawn = [figures.ratio(pair(random, TRUTH, 0.3), pair(random, TRUTH, 0.1)) for _ in range(500)]
        spread = numpy.std([r.value for r in drawn])
        self.assertAlmostEqual(numpy.mean([r.error for r in drawn]) / spread, 1, delta=0.1)
        self.assertAlmostEqual(numpy.mean([r.value for r in drawn]), 1, delta=4 * spread / 500**0.5)
        # The components of a pixel often have the same error: gray noise has the spread of one component, not
        # of three.
        gray = [figures.ratio([TRUTH + random.normal(0, 0.3, (16, 20, 1)) for _ in range(2)], [TRUTH] * 2)
                for _ in range(500)]
        self.assertAlmostEqual(numpy.mean([r.error for r in gray]) / numpy.std([r.value for r in gray]), 1, delta=0.1)

    def test_noise_pictures_differ_as_much_as_noise_makes_the_means_differ(self):
        random = numpy.random.default_rng(2)
        large = numpy.ones((200, 200, 3))
        test, reference = pair(random, large * 1.5, 0.3), pair(random, large, 0.1)
        a, b = figures.mean_pictures(test, reference)
        c, d = figures.noise_pictures(test, reference)
        self.assertAlmostEqual(numpy.std(c - d) / numpy.std(a - b), 1, delta=0.02)
        self.assertAlmostEqual(numpy.mean(c - d), 0, delta=0.01)

    def test_strips_cover_every_column_once(self):
        for count in (1, 3, 5, 7):
            cut = figures.strips(TRUTH, count)
            self.assertEqual(len(cut), count)
            numpy.testing.assert_array_equal(numpy.concatenate(cut, axis=1), TRUTH)

    def test_the_table_marks_what_deviates(self):
        sun = figures.Result("sun", 8, figures.Ratio(1.002, 0.001), 0, 0, 0, 0, {"1.5": figures.Ratio(0.9, 0.001)})
        spot = figures.Result("spot", 8, figures.Ratio(0.7, 0.001), 0, 0, 0, 0, {})
        text = figures.table([(1, sun), (2, spot)])
        self.assertIn("| 1 | `sun` | 8 | 1.0020 ± 0.0010 |", text)
        self.assertIn("| 2 | `spot` | 8 | **0.7000** ± 0.0010 |", text)
        self.assertIn("- `sun`: 1.5: 0.900 ± 0.001", text)
        self.assertTrue(sun.deviates())

    def test_a_result_is_read_as_it_was_written(self):
        result = figures.Result("sun", 8, figures.Ratio(1.002, 0.001), 1, 2, 3, 4, {"1.5": figures.Ratio(0.9, 0.001)})
        with tempfile.TemporaryDirectory() as folder:
            result.save(os.path.join(folder, "result.json"))
            self.assertEqual(figures.Result.load(os.path.join(folder, "result.json")), result)


class SheetTest(unittest.TestCase):
    def test_equal_pictures_differ_by_grey(self):
        shown = sheet.tile(3, TRUTH, TRUTH)
        self.assertEqual(shown.shape, (16, 60, 3))
        numpy.testing.assert_allclose(shown[:, 40:], 0.5)
        self.assertTrue((sheet.tile(3, TRUTH * 1.01, TRUTH)[14:, 40:] > 0.5).all())

    def test_tiles_of_different_heights_do_not_overlap(self):
        tiles = [numpy.full((height, 30, 3), 0.1 * i) for i, height in enumerate((10, 6, 5, 8, 7))]
        result = sheet.contact(tiles, columns=2, gap=2)
        self.assertEqual(result.shape, (10 + 2 + 8 + 2 + 7, 62, 3))
        for i, picture in enumerate(tiles):
            self.assertEqual((result[..., 0] == 0.1 * i).sum(), picture.shape[0] * 30)


if __name__ == "__main__":
    unittest.main()

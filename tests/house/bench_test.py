"""The arithmetic of scripts/bench."""
import importlib.machinery
import importlib.util
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("bench", str(ROOT / "scripts/bench"))
bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
loader.exec_module(bench)


class CameraTest(unittest.TestCase):
    def setUp(self):
        self.text = (ROOT / "recordings/gloss/camera.yaml").read_text()

    def matrix(self, text):
        return [float(number) for number in re.search(r"data: \[([^\]]*)\]", text).group(1).split(",")]

    def test_the_middle_of_the_picture_stays_in_its_middle(self):
        scaled = bench.scaled_camera(self.text, 1.5)
        self.assertIn("image_width: 960", scaled)
        self.assertIn("image_height: 720", scaled)
        self.assertEqual(self.matrix(scaled), [900, 0, 479.5, 0, 900, 359.5, 0, 0, 1])

    def test_a_point_falls_on_the_same_spot_of_the_picture(self):
        text = self.text.replace("3.1950000000000000e+02", "100.25")
        column = lambda values: values[0] * 0.3 + values[2]
        share = (column(self.matrix(text)) + 0.5) / 640
        self.assertAlmostEqual((column(self.matrix(bench.scaled_camera(text, 2.5))) + 0.5) / 1600, share, places=12)

    def test_distortion_stays_for_it_has_no_unit(self):
        text = self.text.replace("data: [ 0., 0., 0., 0., 0. ]", "data: [ -0.2, 0.03, 0., 0., 0. ]")
        self.assertIn("data: [ -0.2, 0.03, 0., 0., 0. ]", bench.scaled_camera(text, 1.5))


class FiguresTest(unittest.TestCase):
    def test_one_slow_round_does_not_move_the_median(self):
        self.assertEqual(bench.spread([2.0, 9.0, 1.0]), (2.0, 1.0, 9.0))

    def test_each_round_is_compared_with_itself(self):
        costs, others = [bench.Cost(3, 8), bench.Cost(10, 6)], [bench.Cost(2, 4), bench.Cost(5, 2)]
        self.assertEqual(bench.ratios(costs, others), [(1.5, 2), (2, 3)])

    def test_each_limit_is_on_programs_that_run(self):
        commands = bench.programs(Path("work"), Path("ring.obj"), Path("million.obj"))
        for row in bench.limits():
            self.assertIn(row.run, commands)
            self.assertIn(row.against or row.run, commands)
            self.assertGreater(row.most, row.strive if row.strive < math.inf else 0)


class RingTest(unittest.TestCase):
    def test_it_has_20000_vertices_and_closes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "ring.obj"
            bench.write_knobby_ring(path)
            lines = [line.split() for line in path.read_text().splitlines()]
        self.assertEqual(sum(words[0] == "v" for words in lines), 20000)
        edges = set()
        for words in (words for words in lines if words[0] == "f"):
            corners = [int(word.split("/")[0]) for word in words[1:]]
            edges |= set(zip(corners, corners[1:] + corners[:1]))
        self.assertEqual(len(edges), 4 * 20000)  # no edge twice in the same sense
        self.assertTrue(all((b, a) in edges for a, b in edges))


if __name__ == "__main__":
    unittest.main()

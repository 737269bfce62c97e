"""Objects that are touched step by step, against laws of their forces."""
import unittest

import numpy as np

import haptrial

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
FACES = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                  [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]])
BLOCK = 0.1 * (CUBE - 0.5)   # a tenth of a metre about the origin


class TouchedMeshTest(unittest.TestCase):
    def test_a_spring_against_a_face(self):
        block = haptrial.TouchedMesh(BLOCK, FACES, stiffness=800.0)
        block.start([0.01, 0.02, 0.06])
        way = np.array([[0.01, 0.02, z] for z in np.linspace(0.06, 0.04, 201)])
        felt = block.follow(way)
        depth = np.maximum(0.05 - way[:, 2], 0.0)
        np.testing.assert_allclose(felt.force[:, 2], 800.0 * depth, atol=1e-9)
        np.testing.assert_allclose(felt.force[:, :2], 0.0, atol=1e-9)
        np.testing.assert_allclose(felt.depth, depth, atol=1e-12)
        np.testing.assert_array_equal(felt.state[depth > 1e-9], "slip")

    def test_steps_are_a_way(self):
        way = np.array([[0.0, 0.0, 0.06], [0.001, 0.0, 0.048], [0.004, 0.001, 0.047]])
        blocks = [haptrial.TouchedMesh(BLOCK, FACES, static_friction=0.5, dynamic_friction=0.3)
                  for _ in range(2)]
        for block in blocks:
            block.start(way[0])
        at_once = blocks[0].follow(way)
        for tool, force, state in zip(way, at_once.force, at_once.state):
            one = blocks[1].step(tool)
            np.testing.assert_array_equal(one.force, force)
            self.assertEqual(one.state, state)

    def test_friction_stays_in_its_cone(self):
        block = haptrial.TouchedMesh(BLOCK, FACES, static_friction=0.6, dynamic_friction=0.4)
        block.start([-0.02, 0.0, 0.051])
        felt = block.follow([[x, 0.0, 0.048] for x in np.linspace(-0.02, 0.02, 400)])
        share = np.abs(felt.force[:, 0]) / felt.force[:, 2]
        self.assertLessEqual(share.max(), 0.6 + 1e-9)
        np.testing.assert_allclose(share[-50:], 0.4, atol=1e-9)
        self.assertIn("stick", felt.state)

    def test_every_renderer_holds_a_tool_out(self):
        for renderer in ("proxy", "penalty", "voxel", "distance field"):
            block = haptrial.TouchedMesh(BLOCK, FACES, renderer=renderer, stiffness=500.0)
            block.start([0.0, 0.0, 0.051])
            self.assertAlmostEqual(block.step([0.0, 0.0, 0.048]).force[2], 1.0, 2, renderer)

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(ValueError, "stiffness"):
            haptrial.TouchedMesh(BLOCK, FACES, stiffness=-1.0)
        with self.assertRaisesRegex(ValueError, "vertices x 3"):
            haptrial.TouchedMesh(BLOCK[:, :2], FACES)
        with self.assertRaisesRegex(ValueError, "magnet"):
            haptrial.TouchedMesh(BLOCK, FACES, renderer="magnet")
        with self.assertRaisesRegex(ValueError, "period"):
            haptrial.TouchedMesh(BLOCK, FACES).step([0.0, 0.0, 0.0], period=0.0)


class SoftBodyTest(unittest.TestCase):
    def pad(self, factor=1.0, **keys):
        return haptrial.SoftBody(size=[0.06, 0.02, 0.06], cells=12, young=20e3 * factor,
                                 poisson=0.4, stiffness=4000.0 * factor, **keys)

    def test_forces_grow_with_the_stiffness_of_all(self):
        # Statics are linear in E and k together, contact or not.
        way = [[0.0, y, 0.0] for y in np.linspace(0.0148, 0.0125, 8)]
        soft, stiff = (self.pad(factor).follow(way) for factor in (1.0, 2.0))
        np.testing.assert_allclose(stiff.force, 2.0 * soft.force, rtol=1e-3, atol=1e-4)
        self.assertGreater(soft.force[-1, 1], 0.1)
        self.assertTrue((np.diff(soft.force[:, 1]) > 0).all())

    def test_the_surface_gives_way_below_the_ball(self):
        pad = self.pad(felt=["top"])
        pad.start([0.0, 0.02, 0.0])
        rest = pad.vertices
        pad.step([0.0, 0.0130, 0.0])
        sunk = rest[:, 1] - pad.vertices[:, 1]
        deepest = np.argmax(sunk)
        self.assertGreater(sunk[deepest], 0.0005)
        self.assertLess(np.linalg.norm(rest[deepest, [0, 2]]), 0.006)
        # No place of the surface is inside the ball, which the force has moved on its spring.
        force = pad.step([0.0, 0.0130, 0.0]).force
        centre = np.array([0.0, 0.0130, 0.0]) + force / 4000.0
        self.assertGreater(np.linalg.norm(pad.vertices - centre, axis=1).min(), 0.005 - 2e-5)
        self.assertEqual(pad.triangles.max() + 1, len(pad.vertices))

    def test_a_surface_is_filled(self):
        cube = haptrial.SoftBody(vertices=BLOCK, triangles=FACES, cells=6, young=10e3, poisson=0.3)
        cube.start([0.0, 0.06, 0.0])
        self.assertGreater(cube.step([0.0, 0.053, 0.0]).force[1], 0.05)

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(ValueError, "either a size or vertices"):
            haptrial.SoftBody(young=1e4, poisson=0.3)
        with self.assertRaisesRegex(ValueError, "allowed: left, right, bottom, top, back, front"):
            self.pad(fixed=["under"])
        with self.assertRaisesRegex(ValueError, "0.7"):
            haptrial.SoftBody(size=[0.1, 0.1, 0.1], cells=4, young=1e4, poisson=0.7)


if __name__ == "__main__":
    unittest.main()

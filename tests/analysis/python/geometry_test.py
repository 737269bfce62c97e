"""Meshes as arrays, on shapes with known answers."""
import unittest

import numpy as np

import haptrial
import support

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
FACES = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                  [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]])


class GeometryTest(unittest.TestCase):
    def test_distances_inside_a_cube(self):
        found = haptrial.distance_map(CUBE, FACES, 10, margin=1, everywhere=True)
        self.assertEqual(found.distance.shape, (12, 12, 12))
        k, j, i = np.indices(found.distance.shape)
        centres = np.stack([found.origin[0] + found.spacing * i,
                            found.origin[1] + found.spacing * j,
                            found.origin[2] + found.spacing * k], axis=-1)
        beyond = np.maximum(np.abs(centres - 0.5) - 0.5, 0.0)
        inside = np.min(0.5 - np.abs(centres - 0.5), axis=-1)
        expected = np.where(found.inside, -inside, np.linalg.norm(beyond, axis=-1))
        np.testing.assert_allclose(found.distance, expected, atol=1e-12)
        self.assertEqual(found.inside.sum(), 1000)
        self.assertTrue(np.isnan(haptrial.distance_map(CUBE, FACES, 10, margin=1).distance[0, 0, 0]))

    def test_axes_are_not_swapped(self):
        box = CUBE * [1.0, 2.0, 4.0]
        self.assertEqual(haptrial.distance_map(box, FACES, 8).distance.shape, (8, 4, 2))

    def test_tetrahedra_fill_the_cube(self):
        vertices, tets = haptrial.tetrahedra(CUBE, FACES, 4)
        self.assertEqual(len(tets), 5 * 64)
        a, b, c, d = (vertices[tets[:, n]] for n in range(4))
        volumes = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6.0
        self.assertTrue((volumes > 0).all())
        self.assertAlmostEqual(volumes.sum(), 1.0, places=12)

    def test_nearest_points(self):
        distance, point, triangle = haptrial.nearest(CUBE, FACES, [[0.5, 0.5, 3.0], [2.0, 2.0, 2.0]])
        np.testing.assert_allclose(distance, [2.0, np.sqrt(3.0)])
        np.testing.assert_allclose(point, [[0.5, 0.5, 1.0], [1.0, 1.0, 1.0]])
        self.assertIn(triangle[0], (2, 3))

    def test_what_has_no_nearest_point(self):
        distance, point, triangle = haptrial.nearest(CUBE, FACES, [[np.nan, 0.0, 0.0]])
        self.assertTrue(np.isnan(distance).all() and np.isnan(point).all())
        self.assertEqual(triangle[0], -1)
        with self.assertRaisesRegex(ValueError, "the mesh has no triangle"):
            haptrial.nearest(CUBE, np.zeros((0, 3), int), [[0.0, 0.0, 0.0]])

    def test_files(self):
        file = support.FOLDER / "cube.off"
        lines = ["OFF", "8 12 0", *(" ".join(map(str, row)) for row in CUBE),
                 *("3 " + " ".join(map(str, row)) for row in FACES)]
        file.write_text("\n".join(lines) + "\n")
        vertices, triangles = haptrial.read_mesh(file)
        np.testing.assert_array_equal(vertices, CUBE)
        np.testing.assert_array_equal(triangles, FACES)

    def test_refuses_in_a_sentence(self):
        with self.assertRaisesRegex(ValueError, "vertices x 3"):
            haptrial.distance_map(CUBE[:, :2], FACES)
        with self.assertRaises(ValueError):
            haptrial.distance_map(CUBE, FACES + 5)
        with self.assertRaises(ValueError):
            haptrial.read_mesh("/nowhere.off")


if __name__ == "__main__":
    unittest.main()

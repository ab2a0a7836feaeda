"""Drags a control point of a sphere from Python and watches the mesh follow, refuse and recover."""

import math
import unittest

import vtknurbs
from vtknurbs import vtkNURBSDeformingTessellator, vtkNURBSShapeSource


class DeformingTessellator(unittest.TestCase):
    def test_a_dragged_control_point(self):
        source = vtkNURBSShapeSource()
        source.SetShapeToSheet()
        source.Update()
        grid = source.GetOutput().NewInstance()
        grid.DeepCopy(source.GetOutput())
        mesher = vtkNURBSDeformingTessellator()
        mesher.SetInputDataObject(grid)
        mesher.Update()
        mesh = mesher.GetOutputDataObject(0)
        self.assertEqual(mesh.GetNumberOfPolys(), mesher.GetNumberOfTriangles())
        points = mesh.GetPoints()
        top = mesh.GetBounds()[5]
        size = grid.GetLength()
        middle = grid.GetNumberOfPoints() // 2 + 20
        x, y, z = grid.GetPoint(middle)
        for height in (1.0, 2.0, math.nan, 3.0):
            grid.GetPoints().SetPoint(middle, x, y, z + height * size)
            grid.GetPoints().Modified()
            good = not math.isnan(height)
            if not good:
                mesher.AddObserver("ErrorEvent", lambda *_: None)
            mesher.Update()
            self.assertEqual(mesher.GetErrorCode() == 0, good)
            self.assertEqual(mesher.GetMovedControlPoints(), 1 if good else 0)
            mesh = mesher.GetOutputDataObject(0)
            self.assertEqual(mesh.GetPoints(), points)
            if good:
                self.assertGreater(mesh.GetBounds()[5], top)
                top = mesh.GetBounds()[5]
                changed = mesh.GetFieldData().GetArray("ChangedPointRange")
                self.assertGreaterEqual(changed.GetComponent(0, 0), 0)
            grid.GetPoints().SetPoint(middle, x, y, z)


if __name__ == "__main__":
    print("vtknurbs", vtknurbs.__version__)
    unittest.main()

"""Draws with vtkNURBSEGLRenderWindow from Python, beside VTK's own classes."""

import unittest
from math import pi

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, vtkRenderer draws with OpenGL
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkWindowToImageFilter,
)

from vtknurbs import vtkNURBSEGLRenderWindow


class EGLRenderWindow(unittest.TestCase):
    def test_sphere_covers_its_disc(self):
        sphere = vtkSphereSource()
        sphere.SetRadius(0.75)
        sphere.SetThetaResolution(200)
        sphere.SetPhiResolution(200)
        mapper = vtkPolyDataMapper()
        mapper.SetInputConnection(sphere.GetOutputPort())
        actor = vtkActor()
        actor.SetMapper(mapper)
        renderer = vtkRenderer()
        renderer.AddActor(actor)
        renderer.SetBackground(0, 0, 1)
        renderer.ResetCamera()
        renderer.GetActiveCamera().ParallelProjectionOn()
        renderer.GetActiveCamera().SetParallelScale(1)

        window = vtkNURBSEGLRenderWindow.Create(240, 200)
        self.assertIsNotNone(window)
        window.SetMultiSamples(0)
        window.AddRenderer(renderer)
        window.Render()
        self.assertTrue(window.IsCurrent())
        self.assertGreater(len(window.GetRendererName()), 0)

        grab = vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        grab.Update()
        image = grab.GetOutput()
        self.assertEqual(image.GetDimensions(), (240, 200, 1))
        scalars = image.GetPointData().GetScalars()
        covered = sum(scalars.GetTuple(i) != (0, 0, 255) for i in range(240 * 200))
        self.assertAlmostEqual(covered / (pi * 75**2), 1, delta=0.01)
        middle = renderer.GetZ(120, 100)
        self.assertLess(middle, renderer.GetZ(120, 170))
        self.assertEqual(renderer.GetZ(1, 1), 1.0)

    def test_wrong_device_is_told(self):
        window = vtkNURBSEGLRenderWindow()
        window.AddObserver("ErrorEvent", lambda *_: None)
        window.SetDeviceIndex(99)
        window.Render()
        self.assertIn("no EGL device 99", window.GetErrorMessage())


if __name__ == "__main__":
    unittest.main()

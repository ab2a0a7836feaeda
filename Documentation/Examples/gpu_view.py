"""Surfaces that the GPU evaluates and trims as it draws: with the faces' edges, with zebra stripes.

    python3 gpu_view.py     writes gpu_view.png and gpu_view_zebra.png
"""

import vtknurbs

source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToTeapot()
mapper = vtknurbs.vtkNURBSMapper()
mapper.SetInputConnection(source.GetOutputPort())
actor = vtknurbs.make_actor(mapper, color=(0.85, 0.87, 0.9))
looks = actor.GetProperty()
looks.SetEdgeColor(0, 0, 0)
looks.SetLineWidth(1.5)
window = vtknurbs.make_window(actor, size=(400, 280), view=(3, -8, 4), zoom=1.5)

looks.EdgeVisibilityOn()  # of the faces: where the control nets end
vtknurbs.grab(window, "gpu_view.png")

looks.EdgeVisibilityOff()
mapper.SetLookToZebra()  # what a mirror would show of a striped room
mapper.SetNumberOfStripes(24)
vtknurbs.grab(window, "gpu_view_zebra.png")

print(f"{mapper.GetNumberOfTriangles()} triangles drawn by {window.GetRendererName()}, at most",
      f"{mapper.GetAchievedPixelError():.3f} pixels from the surface")  # fmt: skip
print(mapper.GetNumberOfBytesSent(), "bytes were sent to the GPU")

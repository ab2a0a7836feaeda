"""A control point of the teapot dragged with the mouse, played with events: the guide's picture.

    PYTHONPATH=build/release/lib/python3/dist-packages \\
        /usr/bin/python3 Documentation/Examples/control_points.py FOLDER
"""

import argparse
import os

from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkWindowToImageFilter
from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor

from vtknurbs import (vtkNURBSControlPointEdits, vtkNURBSControlPointWidget,
                      vtkNURBSEGLRenderWindow, vtkNURBSMapper, vtkNURBSShapeSource)

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("folder")
folder = parser.parse_args().folder

teapot = vtkNURBSShapeSource()
teapot.SetShapeToTeapot()
edits = vtkNURBSControlPointEdits()
edits.SetInputConnection(teapot.GetOutputPort())
mapper = vtkNURBSMapper()
mapper.SetInputConnection(edits.GetOutputPort())
actor = vtkActor()
actor.SetMapper(mapper)
actor.GetProperty().SetColor(0.9, 0.88, 0.8)
renderer = vtkRenderer()
renderer.AddActor(actor)
renderer.SetBackground(1, 1, 1)
renderer.GetActiveCamera().SetPosition(3, -8, 4)
renderer.GetActiveCamera().SetViewUp(0, 0, 1)
renderer.ResetCamera()
renderer.GetActiveCamera().Zoom(1.4)
window = vtkNURBSEGLRenderWindow.Create(400, 280)
if window is None:
    raise SystemExit("no OpenGL; the message above tells why")
window.SetMultiSamples(4)
window.AddRenderer(renderer)
interactor = vtkGenericRenderWindowInteractor()
interactor.SetRenderWindow(window)

widget = vtkNURBSControlPointWidget()
widget.SetInteractor(interactor)
widget.SetCurrentRenderer(renderer)
widget.SetEdits(edits)
widget.On()
handles = widget.GetControlPointRepresentation()
handles.SetNet(handles.NET_OF_SELECTED_FACES)
window.Render()


def send(event, x, y):
    interactor.SetEventInformation(round(x), round(y))
    interactor.InvokeEvent(event)


place = [0.0, 0.0, 0.0]
handles.GetHandleDisplayPosition(0, 69, place)
x, y = place[:2]
send("MouseMoveEvent", x, y)
send("LeftButtonPressEvent", x, y)
send("MouseMoveEvent", x + 35, y - 60)
send("LeftButtonReleaseEvent", x + 35, y - 60)
send("MouseMoveEvent", 1, 1)
print("moved", handles.GetSelectedControlPoint(0), "by", handles.GetDisplacement())

grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(grab.GetOutputPort())
writer.SetFileName(os.path.join(folder, "teapot-handles.png"))
writer.Write()
print("teapot-handles.png")

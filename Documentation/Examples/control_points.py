"""A control point of the teapot dragged with the mouse, here by simulated events, and taken back.

    python3 control_points.py     writes control_points.png
"""

from vtkmodules.vtkRenderingUI import vtkGenericRenderWindowInteractor

import vtknurbs

teapot = vtknurbs.vtkNURBSShapeSource()
teapot.SetShapeToTeapot()
edits = vtknurbs.vtkNURBSControlPointEdits()  # between the model and whatever uses it
edits.SetInputConnection(teapot.GetOutputPort())
window = vtknurbs.make_window(edits, size=(400, 280), view=(3, -8, 4), zoom=1.4)
interactor = vtkGenericRenderWindowInteractor()  # on a desktop: vtkRenderWindowInteractor
interactor.SetRenderWindow(window)
widget = vtknurbs.vtkNURBSControlPointWidget()
widget.SetInteractor(interactor)
widget.SetCurrentRenderer(window.GetRenderers().GetFirstRenderer())
widget.SetEdits(edits)
widget.On()
handles = widget.GetControlPointRepresentation()
handles.SetNet(handles.NET_OF_SELECTED_FACES)
window.Render()

place = [0.0, 0.0, 0.0]
handles.GetHandleDisplayPosition(0, 69, place)  # where handle 69 is on the screen
x, y, _ = map(round, place)
for event, dx, dy in (("MouseMove", 0, 0), ("LeftButtonPress", 0, 0), ("MouseMove", 35, -60),
                      ("LeftButtonRelease", 35, -60), ("MouseMove", 1 - x, 1 - y)):  # fmt: skip
    interactor.SetEventInformation(x + dx, y + dy)
    interactor.InvokeEvent(event + "Event")
print("moved", handles.GetSelectedControlPoint(0), "by", handles.GetDisplacement())
vtknurbs.grab(window, "control_points.png")
edits.Undo()
print(edits.GetNumberOfEdits(), "edits are left,", edits.GetNumberOfRedos(), "can be made again")

# SPDX-License-Identifier: BSD-3-Clause
"""What TestWalkthrough.py runs in the Python shell of ParaView's window."""
import json
import os

from paraview import simple, smtrace
from paraview.servermanager import OutputPort

OUT = os.environ["NURBS_WALKTHROUGH"]


def start():
    """A small view, as pictures are not looked at."""
    simple.GetLayout().PreviewMode = [300, 200]
    smtrace.start_trace()


def select(name):
    """The source of that name, and no other in the view."""
    source = simple.FindSource(name)
    simple.HideAll(simple.GetActiveView())
    simple.Show(source, simple.GetActiveView())
    simple.SetActiveSource(source)


def sizes():
    """Numbers of cells and points of every output in the pipeline, by the names of sources."""
    found = {}
    for (name, _), source in simple.GetSources().items():
        ports = range(source.SMProxy.GetNumberOfOutputPorts())
        information = [OutputPort(source, port).GetDataInformation() for port in ports]
        found[name] = [(i.GetNumberOfCells(), i.GetNumberOfPoints()) for i in information]
    return found


def finish():
    with open(os.path.join(OUT, "trace.py"), "w") as file:
        file.write(smtrace.stop_trace())
    with open(os.path.join(OUT, "sizes.json"), "w") as file:
        json.dump(sizes(), file)

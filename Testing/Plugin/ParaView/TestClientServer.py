# SPDX-License-Identifier: BSD-3-Clause
"""A pvserver of its own: models travel to the client and are drawn there, or on the server.

Run as `pvpython TestClientServer.py PLUGIN FOLDER SERVER`; SERVER is a command line, pvserver, or mpirun
and pvserver.
"""
import os
import socket
import subprocess
import sys

from paraview import simple
from session import PLUGIN, SCREW, path, size, updated
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def picture(name):
    simple.SaveScreenshot(path(name), view)
    reader = vtkPNGReader()
    reader.SetFileName(path(name))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def selected(name):
    """Pixels in the selection's colour, which light shades and tints."""
    red, green, blue = picture(name)[:, :3].T
    return (abs(red - blue) < 25) & (red > 100) & (green < 10)


with socket.socket() as free:
    free.bind(("localhost", 0))
    port = free.getsockname()[1]
# It ends with the client's connection, at the end of this script.
# pvpython is a process of MPI itself, and tells so to what it starts; mpirun is to start anew.
alone = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "OPAL_"))}
server = subprocess.Popen(
    ["timeout", "100"] + sys.argv[3].split() + ["--server-port=%d" % port],
    env=alone,
    stdout=subprocess.PIPE,
    universal_newlines=True,
)
try:
    # The server tells when it listens; it takes one connection only.
    for line in server.stdout:
        if "Accepting connection" in line:
            break
    simple.Connect("localhost", port)
    simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
    simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
    reader = updated(simple.OpenDataFile(SCREW))
    mesh = updated(simple.NURBSTessellator(Input=reader, Tolerance=1e-4))
    assert (size(reader)[0], size(mesh)[0]) == (10, 2186)
    assert mesh.NumberOfTriangles == 2186

    view = simple.CreateView("RenderView")
    view.ViewSize = [200, 150]
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0
    display = simple.Show(reader, view)
    assert display.Representation == "NURBS Surface"
    # So does what a filter of ParaView passes on, which only the server can tell from cut cells.
    for name, wanted in (("Transform", "NURBS Surface"), ("Clip", "Surface")):
        made = updated(getattr(simple, name)(Input=reader))
        assert simple.Show(made, view).Representation == wanted, name
        simple.Delete(made)
    view.ResetCamera(True)
    view.RemoteRenderThreshold = 1000.0  # MiB: the client draws
    here = picture("drawn-here.png")
    view.RemoteRenderThreshold = 0.0
    there = picture("drawn-there.png")
    assert (here != here[0]).any(axis=1).sum() > 5000
    differ = (abs(here - there) > 2).any(axis=1).sum()
    print("drawn by the client and by the server: %d pixels differ" % differ)
    assert differ < 20

    # A selected face has its colour, whoever draws, and loses it. Of several processes, each has a face
    # that is selected; the numbers of these in their pieces are the same.
    middle = [100, 100, 100, 100]
    everywhere = [0, 0, 199, 149]
    simple.SelectSurfaceCells(Rectangle=middle, View=view)
    there = selected("remote-selected-there.png")
    view.RemoteRenderThreshold = 1000.0
    here = selected("remote-selected-here.png")
    print("selected: %d pixels by the client, %d by the server" % (here.sum(), there.sum()))
    assert there.sum() > 800 and (here != there).sum() < 20
    simple.ClearSelection(reader)
    assert not selected("remote-unselected.png").any()
    simple.SelectSurfaceCells(Rectangle=middle, View=view)
    assert (selected("remote-again.png") != here).sum() < 20
    for name in ("all-there", "all-here"):
        view.RemoteRenderThreshold = 0.0 if name == "all-there" else 1000.0
        simple.SelectSurfaceCells(Rectangle=everywhere, View=view)
        assert selected("remote-%s.png" % name).sum() > 2 * here.sum()
    simple.ClearSelection(reader)
    sizes = [p.GetDataInformation().GetMemorySize() for p in (reader, mesh)]
    print("%d KiB as surfaces, %d KiB as triangles within 1e-4" % tuple(sizes))
    assert sizes[0] < sizes[1]
    print("passed")
except BaseException:
    server.kill()
    raise

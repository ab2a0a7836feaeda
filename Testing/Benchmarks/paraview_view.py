# SPDX-License-Identifier: BSD-3-Clause
"""A CAD file in ParaView's render view: surfaces by the mapper beside triangles of the tessellator.

    xvfb-run -a pvpython Testing/Benchmarks/paraview_view.py PLUGIN [FILE]

PLUGIN is NURBS.so, FILE a CAD file (default: a car body of 8,036 trimmed patches). Each line is a
session of its own, in one process or as a client that draws what its server sends. Seconds are those
of the processor, all threads, client and server together, at 800 x 600 pixels: from opening the file
to the first picture, a still frame, and a frame while the camera turns by one degree. Frames a second
are what one core would reach. Memory is the most that each process had, less what it had when the
plugin was loaded and an empty view drawn. Triangles are within 1e-4 of the diagonal.
"""
import json
import os
import resource
import shutil
import socket
import subprocess
import sys
import time

from paraview import simple

SIDES = {
    "NURBS Surface": [],
    "NURBS Surface, no exact fragments": [("ExactFragments", 0)],
    "triangles as Surface": None,
}


def server_status(pid, key):
    with open("/proc/%d/status" % pid) as file:
        return int(next(line for line in file if line.startswith(key)).split()[1]) / 1024


class Watch:
    """Processor seconds and MiB of this process and, if there is one, of the server."""

    def __init__(self, server):
        self.server = server
        self.start = self.seconds()
        self.memory = [self.now(), server_status(server, "VmRSS") if server else 0.0]

    @staticmethod
    def now():
        return server_status(os.getpid(), "VmRSS")

    def seconds(self):
        mine = time.process_time()
        if not self.server:
            return mine
        with open("/proc/%d/stat" % self.server) as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return mine + sum(int(n) for n in fields[11:13]) / os.sysconf("SC_CLK_TCK")

    def lap(self):
        then, self.start = self.start, self.seconds()
        return self.start - then

    def peak(self):
        mine = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        theirs = server_status(self.server, "VmHWM") if self.server else 0.0
        return [mine - self.memory[0], theirs - self.memory[1]]


def frames(watch, view, render, count):
    def turn():
        for _ in range(count):
            view.GetActiveCamera().Azimuth(1)
            render()

    turn()  # what is made once
    watch.lap()
    turn()
    return watch.lap() / count


def start(plugin, port):
    if port:
        simple.Connect("localhost", port)
        simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    view = simple.CreateView("RenderView")
    view.ViewSize = [800, 600]
    view.RemoteRenderThreshold = 100000.0  # MiB: the client draws.
    simple.Render(view)
    return view


def measure(side, plugin, path, port, server):
    """One session; prints what it found as JSON."""
    view = start(plugin, port)
    watch = Watch(server)
    if path:
        shown = simple.OpenDataFile(path)
    else:
        shown = simple.NURBSShapeSource(Shape="Car Body", NumberOfPatches=8036)
    shown.UpdatePipeline()
    settings = SIDES[side]
    if settings is None:
        shown = simple.NURBSTessellator(Input=shown, Tolerance=1e-4)
        shown.UpdatePipeline()
    made = watch.lap()
    display = simple.Show(shown, view)
    for key, value in settings or ():
        setattr(display, key, value)
    view.ResetCamera(True)
    simple.Render(view)
    first = watch.lap()
    still = frames(watch, view, view.SMProxy.StillRender, 3)
    moving = frames(watch, view, view.SMProxy.InteractiveRender, 10)
    about = shown.GetDataInformation()
    found = [made, made + first, still, moving] + watch.peak()
    found += [about.GetNumberOfCells(), about.GetMemorySize() / 1024]
    print("found " + json.dumps(found))


def session(side, plugin, path, remote):
    """What measure() found in a process of its own."""
    command = [shutil.which("pvpython"), __file__, "--measure", side, plugin, path]
    if not remote:
        return run(command + ["0", "0"])
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen(
        [shutil.which("pvserver"), "--server-port=%d" % port],
        stdout=subprocess.PIPE,
        universal_newlines=True,
    )
    try:
        for line in server.stdout:
            if "Accepting connection" in line:
                break
        return run(command + [str(port), str(server.pid)])
    finally:
        server.kill()


def run(command):
    text = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.decode()
    return json.loads(next(l for l in text.splitlines() if l.startswith("found "))[6:])


def main(plugin, path=""):
    head = ("read, made", "1st picture", "still", "moving", "frames/s", "MiB", "of server", "data MiB")
    print(("%-34s" + "%12s" * len(head)) % (("",) + head))
    for remote in (False, True):
        print("client and server" if remote else "one process")
        for side in SIDES:
            made, first, still, moving, mine, theirs, cells, data = session(
                side, plugin, path, remote
            )
            row = (made, first, still, moving, 1.0 / moving, mine, theirs, data)
            print(("  %-32s" + "%12.2f" * 4 + "%12.1f" * 4) % ((side,) + row), flush=True)
    print("%d triangles" % cells)


if sys.argv[1] == "--measure":
    measure(*sys.argv[2:5], int(sys.argv[5]), int(sys.argv[6]))
else:
    main(*sys.argv[1:3])

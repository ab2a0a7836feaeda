# SPDX-License-Identifier: BSD-3-Clause
"""Every source and filter of the NURBS menus applied in ParaView's window, and the looks of surfaces.

    pvpython TestWalkthrough.py PLUGIN FOLDER PARAVIEW

Nothing is told as an error or a warning, no output is empty, panels show what applies and no more, and
the trace of it all makes the same in pvpython.
"""
import json
import os
import shutil
import subprocess
import sys
from xml.sax.saxutils import quoteattr

from paraview import simple
from session import FILTERS, FOLDER, PLUGIN, SCREW, load_plugin

HERE = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(FOLDER, "walkthrough")
MAIN = "pqClientMainWindow/"
PANEL = MAIN + "propertiesDock/propertiesPanel/"
CONTENTS = PANEL + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/"
PROPERTIES = CONTENTS + "PropertiesFrame/ProxyPanel/"
DISPLAY = CONTENTS + "DisplayFrame/ProxyPanel/"
READER = os.path.basename(SCREW)


class Script:
    """Events for ParaView's test player."""

    def __init__(self):
        self.lines = []

    def line(self, tag, **attributes):
        text = " ".join("%s=%s" % (key, quoteattr(value)) for key, value in attributes.items())
        self.lines.append("  <%s %s />" % (tag, text))

    def event(self, widget, command, arguments=""):
        self.line("pqevent", object=widget, command=command, arguments=arguments)

    def menu(self, *names):
        place = MAIN + "menubar"
        for name in names:
            self.event(place, "activate", name)
            place += "/" + name

    def apply(self):
        self.event(PANEL + "Accept", "activate")

    def python(self, code):
        self.event(MAIN + "pythonShellDock/pythonShell/consoleWidget", "executeCommand", code)

    def choose(self, place, name, text):
        self.event("%s%s/ComboBox" % (place, name), "set_string", text)

    def check(self, place, name, shown):
        state = "true" if shown else "false"
        self.line("pqcheck", object=place + name, property="visible", arguments=state)

    def save(self, path):
        with open(path, "w") as file:
            file.write('<?xml version="1.0" ?>\n<pqevents>\n%s\n</pqevents>\n' % "\n".join(self.lines))


def settings(script, name):
    """What a person may do in a panel before Apply, and what shows then."""
    if name == "NURBSTessellator":
        script.choose(PROPERTIES, "ToleranceMode", "A length")
        script.check(PROPERTIES, "Tolerance", False)
        script.check(PROPERTIES, "AbsoluteTolerance", True)
    elif name in ("NURBSSilhouette", "NURBSVisibleRegions"):
        # The view as it is, by itself.
        script.check(PROPERTIES, "Direction", False)
        script.check(PROPERTIES, "EyePoint", True)
        script.event(PROPERTIES + "SharpEdges/CheckBox", "set_boolean", "false")
        script.check(PROPERTIES, "FeatureAngle", False)
        script.event(PROPERTIES + "SharpEdges/CheckBox", "set_boolean", "true")
        script.check(PROPERTIES, "FeatureAngle", True)
    elif name == "NURBSFreeFormDeformation":
        script.event(PROPERTIES + "UseInputBounds/CheckBox", "set_boolean", "false")
        script.check(PROPERTIES, "Bounds", True)
        script.check(PROPERTIES, "Margin", False)


def looks(script):
    """The display of surfaces."""
    script.check(DISPLAY, "LookDirection", False)
    for look, has_legend, has_direction in (
        ("Mean Curvature", True, False),
        ("Draft Angle", True, True),
        ("Isophotes", False, True),
        ("Zebra", False, True),
    ):
        script.choose(DISPLAY, "Look", look)
        script.check(DISPLAY, "ShowLegend", has_legend)
        script.check(DISPLAY, "LookDirection", has_direction)
    script.event(DISPLAY + "FaceEdges/CheckBox", "set_boolean", "true")


def play():
    script = Script()
    script.python("import walkthrough; walkthrough.start()")
    script.menu("menuSources", "NURBS", "NURBSShapeSource")
    script.apply()
    script.menu("menu_File", "actionFileOpen")
    script.event(MAIN + "FileOpenDialog", "filesSelected", "$PARAVIEW_DATA_ROOT/" + READER)
    script.apply()
    looks(script)
    for name in FILTERS:
        script.python("walkthrough.select(%r)" % READER)
        script.menu("menuFilters", "NURBS", name)
        settings(script, name)
        script.apply()
    script.python("walkthrough.select('NURBSToBezierCells1')")
    script.menu("menuFilters", "NURBS", "NURBSFromBezierCells")
    script.apply()
    script.python("walkthrough.finish()")
    script.save(os.path.join(OUT, "walkthrough.xml"))
    environment = dict(os.environ, HOME=OUT, XDG_CONFIG_HOME=OUT, XDG_RUNTIME_DIR=OUT)
    environment.update(NURBS_WALKTHROUGH=OUT, PYTHONPATH=HERE)
    command = [sys.argv[3], "--dr", "--plugins=NURBS", "--test-directory=" + OUT]
    command += ["--plugin-search-paths=" + os.path.dirname(PLUGIN)]
    command += ["--data-directory=" + os.path.dirname(SCREW)]
    command += ["--test-script=" + os.path.join(OUT, "walkthrough.xml"), "--exit"]
    done = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=540
    )
    return done.stdout.decode(errors="replace")


shutil.rmtree(OUT, ignore_errors=True)
os.makedirs(OUT, mode=0o700)
text = play()
print(text)
assert "Success =  true" in text and "caught a signal" not in text
for trouble in ("ERR|", "WARN|", "ERROR: ", "Warning: ", "critical: ", "warning: ", "Traceback"):
    assert trouble not in text, trouble

with open(os.path.join(OUT, "sizes.json")) as file:
    sizes = json.load(file)
expected = [READER] + [name + "1" for name in FILTERS + ["NURBSShapeSource", "NURBSFromBezierCells"]]
assert sorted(sizes) == sorted(expected), sizes
for name, ports in sizes.items():
    print("%-28s %s" % (name, ports))
    assert all(cells > 0 and points > 0 for cells, points in ports), name

# The trace, in a session that has the plugin.
load_plugin()
with open(os.path.join(OUT, "trace.py")) as file:
    trace = file.read()
for name in FILTERS:
    assert name + "(" in trace, name
exec(compile(trace, "trace", "exec"), {"__name__": "replayed"})
os.environ["NURBS_WALKTHROUGH"] = OUT
import walkthrough  # noqa: E402, as it looks for the folder

for source in simple.GetSources().values():
    source.UpdatePipeline()
made = {name: [list(size) for size in ports] for name, ports in walkthrough.sizes().items()}
assert made == sizes, {name: (made.get(name), sizes[name]) for name in sizes if made.get(name) != sizes[name]}
display = simple.GetDisplayProperties(simple.FindSource(READER), simple.GetActiveView())
assert (display.Look, display.FaceEdges) == ("Zebra", 1), "of the trace"
print("passed")

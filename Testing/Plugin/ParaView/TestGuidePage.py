# SPDX-License-Identifier: BSD-3-Clause
"""Runs the Python snippets of the guide's page on ParaView, one after the other, as they stand there."""
import os
import re
import sys

from session import FOLDER, PLUGIN

with open(sys.argv[3], encoding="utf-8") as page:
    snippets = re.findall(r"^```python\n(.*?)^```", page.read(), re.M | re.S)
assert len(snippets) >= 2
os.makedirs(FOLDER, exist_ok=True)
os.chdir(FOLDER)
names = {}
for number, snippet in enumerate(snippets, 1):
    # The one thing that is elsewhere: the build tree.
    code = re.sub(r'LoadPlugin\("[^"]+"', 'LoadPlugin("%s"' % PLUGIN, snippet)
    exec(compile(code, "snippet %d" % number, "exec"), names)
assert os.path.getsize("drawing.png") > 1000
assert os.path.getsize("drawing.svg") > 1000
print("passed")

"""Runs all Python snippets of a page of the guide, one after the other, as they stand there."""

import os
import re
import sys
import tempfile
from pathlib import Path

page = Path(sys.argv[1])
snippets = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
assert snippets, f"{page} holds no snippet"
names = {}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for number, snippet in enumerate(snippets, 1):
        exec(compile(snippet, f"{page.name}, snippet {number}", "exec"), names)
print(page.name + ":", len(snippets), "snippets ran")

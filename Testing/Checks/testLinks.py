"""Tries links.py on pages and on a site with one defect of each kind."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import links  # noqa: E402

with tempfile.TemporaryDirectory() as folder:
    links.ROOT = Path(folder).resolve()
    guide = links.ROOT / "Documentation" / "Guide"
    guide.mkdir(parents=True)
    (links.ROOT / "README.md").write_text("# A\n\n[guide](Documentation/Guide/README.md) [b](#a)\n")
    (guide / "README.md").write_text("# Guide\n\n[Page](Page.md#two-words) `[no](link)`\n")
    (guide / "Page.md").write_text("# Page\n\n## Two words\n\n```\n[no](link)\n```\n\n    [no](link)\n")
    assert links.check_pages()[0] == [], links.check_pages()

    (guide / "Page.md").write_text("[x](None.md)\n![y](none.png)\n[z](README.md#none)\n[w](../../../a)\n")
    (guide / "Alone.md").write_text("# Alone\n")
    dead = links.check_pages()[0]
    wanted = ("None.md is", "none.png is", "README.md#none names", "../../../a is", "#two-words names")
    for part in (*wanted, "has no link to Alone.md"):
        assert sum(part in line for line in dead) == 1, (part, dead)
    assert len(dead) == 6, dead

    (guide / "a.html").write_text('<a href="b.html#c">x</a><img src="p.png"><a href="#d">y</a>')
    (guide / "b.html").write_text('<h1 id="other">z</h1><a href="a.html">x</a>')
    dead = links.check_site(guide)[0]
    assert sorted(dead) == [
        "a.html: #d names no place", "a.html: b.html#c names no place", "a.html: p.png is not there",
    ], dead  # fmt: skip
print("links.py finds what it should")

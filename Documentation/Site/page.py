#!/usr/bin/env python3
"""Doxygen's filter of the Markdown pages: names pages and headings as links between them need it.

    page.py FILE.md       prints the page for Doxygen
    page.py --layout      prints Doxygen's layout: layout.xml with a tab a folder, and its pages below that

GitHub's links are paths (`../Papers/li-1997.md#measured`), Doxygen's are names of pages and headings.
A page is called after its folder and file (`papers-li-1997`, a README.md after its folder alone), a
heading after its page and text. A folder's README.md makes the other pages of the folder its children.
"""

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")


def slug(heading):
    """The anchor that GitHub gives a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def page_name(path):
    parts = path.resolve().relative_to(ROOT).with_suffix("").parts
    if parts == ("README",):
        return "mainpage"
    parts = [part.lower() for part in parts if part not in ("Documentation", "README")]
    return "-".join(parts)


def convert_link(match, page):
    image, text, target = match.groups()
    if re.match(r"[a-z]+:", target):
        return match.group()
    path, _, anchor = target.partition("#")
    file = (page.parent / path).resolve() if path else page
    if image:
        return f"![{text}]({file.name})"
    if file.is_dir():
        file = file / "README.md"
    if file.suffix != ".md":
        return f"[{text}]({os.path.relpath(file, ROOT)})"
    name = page_name(file)
    if anchor:
        return f"[{text}](@ref {name}-{anchor})"
    if page.name == "README.md" and file.parent == page.parent and file != page:
        return f'@subpage {name} "{text}"'
    return f"[{text}](@ref {'index' if name == 'mainpage' else name})"


def convert(page):
    name = page_name(page)
    fenced = False
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            fenced = not fenced
        if fenced or line.startswith("    "):
            yield line
            continue
        heading = re.match(r"(#+) (.*)", line)
        if heading:
            level, text = heading.groups()
            label = name if len(level) == 1 else f"{name}-{slug(text)}"
            yield f"{line} {{#{label}}}"
            continue
        # Not in `code`: every second part between backquotes.
        parts = line.split("`")
        parts[::2] = [LINK.sub(lambda match: convert_link(match, page), part) for part in parts[::2]]
        yield "`".join(parts)


def tab(folder):
    """The tab of a folder's README.md, with the pages that it links in the order of its links."""
    index = ROOT / "Documentation" / folder / "README.md"
    title = index.read_text(encoding="utf-8").splitlines()[0].lstrip("# ")
    lines = [f'    <tab type="usergroup" url="@ref {page_name(index)}" title="{title}">']
    for _, text, target in LINK.findall(index.read_text(encoding="utf-8")):
        file = (index.parent / target).resolve()
        if file.parent == index.parent and file.suffix == ".md":
            lines.append(f'      <tab type="user" url="@ref {page_name(file)}" title="{text}"/>')
    return "\n".join([*lines, "    </tab>"])


def layout():
    text = (ROOT / "Documentation" / "Site" / "layout.xml").read_text(encoding="utf-8")
    folders = ("Guide", "Examples", "Papers", "Developer", "decisions")
    present = [f for f in folders if (ROOT / "Documentation" / f / "README.md").exists()]
    return text.replace("    <!-- folders -->", "\n".join(map(tab, present)))


if __name__ == "__main__":
    if sys.argv[1] == "--layout":
        print(layout())
    else:
        print("\n".join(convert(Path(sys.argv[1]).resolve())))

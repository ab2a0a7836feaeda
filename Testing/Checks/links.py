#!/usr/bin/env python3
"""Looks for dead links in the Markdown pages, or in a site that was made of them.

    Testing/Checks/links.py                relative links, pictures and anchors of all pages
    Testing/Checks/links.py --files        prints the linked files that are neither pages nor pictures
    Testing/Checks/links.py --site FOLDER  links and pictures of all *.html in FOLDER
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Documentation" / "Site"))
from page import LINK, slug  # noqa: E402

PICTURES = {".png", ".gif", ".svg", ".jpg"}


def text_of(page):
    """The page without code, where a bracket is no link."""
    text = page.read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    text = re.sub(r"^    .*$", "", text, flags=re.M)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(page):
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    return {slug(heading) for heading in re.findall(r"^#+ (.*)", text, flags=re.M)}


def pages():
    folders = [p for p in ROOT.iterdir() if p.is_dir() and p.name != "build" and p.name[0] != "."]
    return sorted([*ROOT.glob("*.md"), *(page for p in folders for page in p.rglob("*.md"))])


def targets(page):
    """Of each relative link of a page: the link, the file it means, and the anchor."""
    for _, _, link in LINK.findall(text_of(page)):
        if not re.match(r"[a-z]+:", link):
            path, _, anchor = link.partition("#")
            yield link, (page.parent / path).resolve() if path else page, anchor


def check_pages():
    dead, count = [], 0
    for page in pages():
        for link, file, anchor in targets(page):
            count += 1
            if not file.exists() or ROOT not in file.parents:
                dead.append(f"{page.relative_to(ROOT)}: {link} is not there")
            elif anchor and anchor not in anchors(file):
                dead.append(f"{page.relative_to(ROOT)}: {link} names no heading")
        # The site's navigation is made of these links.
        if page.name == "README.md" and page.parent.parent == ROOT / "Documentation":
            linked = {file for _, file, _ in targets(page)}
            for other in sorted(set(page.parent.glob("*.md")) - linked - {page}):
                dead.append(f"{page.relative_to(ROOT)}: has no link to {other.name}")
    return dead, f"{count} links of {len(pages())} pages"


class Links(HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.names = set(), set()

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("href", "src") and value:
                self.links.add(value)
            elif key in ("id", "name") and value:
                self.names.add(value)


def check_site(folder):
    parsed = {}
    for page in sorted(folder.glob("*.html")):
        parsed[page.name] = Links()
        parsed[page.name].feed(page.read_text(encoding="utf-8"))
    dead, count = [], 0
    for name, page in parsed.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            count += 1
            path, _, anchor = unquote(link).partition("#")
            path = path or name
            if not (folder / path).exists():
                dead.append(f"{name}: {link} is not there")
            elif anchor and path in parsed and anchor not in parsed[path].names:
                dead.append(f"{name}: {link} names no place")
    return dead, f"{count} links of {len(parsed)} HTML pages"


def main():
    if sys.argv[1:] == ["--files"]:
        files = {file for page in pages() for _, file, _ in targets(page)}
        for file in sorted(files):
            if file.is_file() and file.suffix not in {".md"} | PICTURES:
                print(file.relative_to(ROOT))
        return 0
    if len(sys.argv) == 3 and sys.argv[1] == "--site":
        dead, what = check_site(Path(sys.argv[2]))
    elif len(sys.argv) == 1:
        dead, what = check_pages()
    else:
        print(__doc__)
        return 2
    for line in dead:
        print(line)
    print(f"links: {len(dead)} dead among {what}")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())

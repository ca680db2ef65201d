#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks what the documentation refers to: links between the pages and to their sections, files named in
backticks, and the pages and sections that comments of the sources cite.

    scripts/check_documentation.py [TOP]

Prints one line for each reference that leads nowhere; the exit code is 1 if there is one.
"""

import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\s]+)`")
# Files that these folders hold are named from the top; headers and sources may leave out include/gemmule or source.
TOP_FOLDERS = ("doc", "include", "parameters", "postprocess", "scripts", "source", "tests")
CITATION = re.compile(r"doc/([a-z-]+\.md)(?:[,:]? \"([^\"]+)\")?")


def slug(heading):
    """The anchor that forges give a heading."""
    text = re.sub(r"[`*]|\[([^]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def headings(page):
    """The headings of a page, without those of quoted code."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    return [line.lstrip("#").strip() for line in text.splitlines() if re.match(r"#+ ", line)]


def broken_links(page):
    """The links of a page to files and sections that are not there."""
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        if not target.exists():
            yield f"{link}: there is no such file"
        elif anchor and target.suffix == ".md" and anchor not in map(slug, headings(target)):
            yield f"{link}: there is no such section"


def missing_files(page, top):
    """The files of the sources that a page names and that are not there."""
    for name in sorted(set(CODE.findall(page.read_text(encoding="utf-8")))):
        name = name.rstrip(",.:").split("#")[0]
        if re.search(r"[<>{}()$…=]|NNN|\.\.\.", name) or "/" not in name:
            continue
        places = [top] if name.split("/")[0] in TOP_FOLDERS else []
        if re.search(r"\.(h|cc)$", name):
            places += [top / "include" / "gemmule", top / "source", top / "tests"]
        if not places:
            continue
        if not any(any(place.glob(name.rstrip("/"))) for place in places):
            yield f"`{name}`: there is no such file"


def broken_citations(source, top):
    """The pages and sections that the comments of a source file cite and that are not there."""
    text = re.sub(r"\n\s*(?:\*|///?|#)\s*", " ", source.read_text(encoding="utf-8"))
    for name, section in CITATION.findall(text):
        page = top / "doc" / name
        if not page.exists():
            yield f"doc/{name}: there is no such page"
        elif section and section not in headings(page):
            yield f"doc/{name}, \"{section}\": there is no such section"


def check(top):
    """All references that lead nowhere, as lines of text."""
    complaints = []
    for page in sorted(top.glob("*.md")) + sorted((top / "doc").glob("*.md")):
        for complaint in [*broken_links(page), *missing_files(page, top)]:
            complaints.append(f"{page.relative_to(top)}: {complaint}")
    for folder in ("include", "source", "tests", "postprocess"):
        for source in sorted((top / folder).rglob("*")):
            if source.suffix in (".h", ".cc", ".py", ".cmake", ".txt"):
                for complaint in broken_citations(source, top):
                    complaints.append(f"{source.relative_to(top)}: {complaint}")
    return complaints


def main(arguments):
    """Checks the sources in the folder given, by default those that this script belongs to."""
    top = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).resolve().parent.parent)
    complaints = check(top)
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

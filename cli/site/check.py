# SPDX-License-Identifier: MIT
"""Checks a built site: links and anchors, nothing from outside, nothing missing.

    check.py HTML ROOT PROGRAM

HTML is the folder of the site, ROOT the repository, PROGRAM the gatewalk that it was made with; `import gatewalk` must
find the module of the same build.
"""

import html.parser
import pathlib
import re
import subprocess
import sys
import urllib.parse

import gatewalk

import prepare

# A user of the installed libraries looks for these first.
CPP = ["dynamics::Transitions", "dynamics::StateSpace", "dynamics::GateParams", "dynamics::Cell",
       "lattice::make_chain", "lattice::chain_start", "lattice::Source", "markov::Chain", "markov::FieldChain",
       "markov::Counts", "markov::Walker", "markov::Ending", "markov::Exit"]
LOADS = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src",
         "embed": "src", "object": "data", "image": "href", "use": "href"}
NOT_LOADED = ("canonical", "index", "search", "next", "prev", "author", "copyright")
VERSIONS = {"CHANGELOG.md": r"^## ([\d.]+) - ", "CITATION.cff": r"^version: (\S+)",
            "cli/packaging/changelog": r"^gatewalk \((.*?)\)"}


class Page(html.parser.HTMLParser):
    """What a page is called by, links to, and loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.words = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {key: value or "" for key, value in attrs}
        if "id" in given:
            self.ids.add(given["id"])
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if tag == "link" and given.get("rel") not in NOT_LOADED:
            self.loads.append(given.get("href", ""))
        if tag in LOADS and LOADS[tag] in given:
            target = given[LOADS[tag]]
            (self.links if target.startswith("#") else self.loads).append(target)
        self.loads += re.findall(r"url\(['\"]?([^'\")]+)", given.get("style", ""))

    def handle_data(self, data: str) -> None:
        self.words += data


def is_outside(target: str) -> bool:
    return bool(re.match(r"[a-z][a-z0-9+.-]*:|//", target)) and not target.startswith("data:")


def links(site: pathlib.Path, pages: dict[pathlib.Path, Page]) -> list[str]:
    """Links to nowhere, and what a page loads from outside or from nowhere."""
    wrong = []
    for path, page in pages.items():
        name = path.relative_to(site)
        for target in page.loads:
            local = path.parent / urllib.parse.unquote(urllib.parse.urlsplit(target).path)
            if is_outside(target):
                wrong.append(f"{name}: loads {target}")
            elif not target.startswith("data:") and not local.is_file():
                wrong.append(f"{name}: loads {target}, which is not there")
        for target in page.links:
            if is_outside(target):
                continue
            parts = urllib.parse.urlsplit(target)
            there = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path.resolve()
            anchor = urllib.parse.unquote(parts.fragment)
            if not there.is_file():
                wrong.append(f"{name}: a link to {target}, which is not there")
            elif anchor and there in pages and anchor not in pages[there].ids:
                wrong.append(f"{name}: a link to {target}, which has no such anchor")
    for sheet in [*site.rglob("*.css"), *site.rglob("*.svg")]:
        text = sheet.read_text(encoding="utf-8", errors="replace")
        for target in re.findall(r"url\(['\"]?([^'\")]+)|@import ['\"]([^'\"]+)", text):
            loaded = "".join(target)
            if is_outside(loaded) or not (loaded.startswith(("data:", "#")) or (sheet.parent / loaded).is_file()):
                wrong.append(f"{sheet.relative_to(site)}: loads {loaded}")
    return wrong


def missing(site: pathlib.Path, pages: dict[pathlib.Path, Page], root: pathlib.Path, program: str) -> list[str]:
    """What the site must have and has not."""
    wrong = []
    ids = {str(path.relative_to(site)): page.ids for path, page in pages.items()}
    for name in gatewalk.__all__:
        if f"gatewalk.{name}" not in ids.get("python.html", ()):
            wrong.append(f"python.html: gatewalk.{name} is not documented")
    overview = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.findall(r"^  ([\w-]+(?: \w+)?)  +\w", overview, re.M)
    if not commands:
        wrong.append("gatewalk --help names no commands")
    for command in commands:
        own = subprocess.run([program, "help", *command.split()], capture_output=True, text=True, check=True).stdout
        name = command.replace(" ", "-")
        page = f"commands/{name}.html"
        for option in re.findall(r"^  (?:-\w \[ )?(--[\w-]+)", own, re.M):
            if f"cmdoption-gatewalk-{name}-{option.removeprefix('--')}" not in ids.get(page, ()):
                wrong.append(f"{page}: {option} is not documented")
    declared = " ".join(" ".join(found) for page, found in ids.items() if page.startswith("cpp/"))
    for name in CPP:
        coded = "8gatewalk" + "".join(f"{len(part)}{part}" for part in name.split("::")) + "E"
        if coded not in declared:
            wrong.append(f"cpp/: gatewalk::{name} is not documented")
    for name, pattern in VERSIONS.items():
        version = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.M)
        if version is None or version[1] != gatewalk.__version__:
            wrong.append(f"{name} is of version {version and version[1]}, not {gatewalk.__version__}")
    for page in prepare.tracked(root):
        if prepare.place_of(page).removesuffix(".md") + ".html" not in ids:
            wrong.append(f"{page} is no page of the site")
    return wrong


def main() -> None:
    site, root, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), sys.argv[3]
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    wrong = links(site, pages) + missing(site, pages, root, program)
    print("\n".join(wrong) or f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links: all fine")
    sys.exit(1 if wrong else 0)


main()

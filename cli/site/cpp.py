# SPDX-License-Identifier: MIT
"""The C++ reference: doxygen's XML of the installed headers, and pages that show it by breathe.

Each header is a group of doxygen's, so that it is shown by itself, with the text at its beginning.
"""

import pathlib
import re
import subprocess
import xml.etree.ElementTree as ElementTree

DOXYFILE = """
PROJECT_NAME = gatewalk
INPUT = .
RECURSIVE = YES
FILE_PATTERNS = *.h
OUTPUT_DIRECTORY = .
GENERATE_XML = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
EXTRACT_ALL = YES
XML_PROGRAMLISTING = NO
AUTOLINK_SUPPORT = NO
EXCLUDE_SYMBOLS = each_part
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


INDEX = """C++ reference
=============

All installed headers, with what they declare. :doc:`From C++ </guides/library>` explains by examples how to use them.
A program calls ``find_package(gatewalk)`` and links ``gatewalk::dynamics``, ``gatewalk::markov`` or
``gatewalk::lattice``, which brings the other two. Folder, namespace and library have the same name.
``lattice/lattice.h`` includes what most programs need, ``markov/markov.h`` what chains alone need.

A member's default with named parts (``= {.trials = 100}``) is not shown.
"""


def _installed(root: pathlib.Path, module: str) -> list[str]:
    """The headers that a module installs, as its CMakeLists.txt names them."""
    text = (root / module / "CMakeLists.txt").read_text(encoding="utf-8")
    public = re.search(r"^gatewalk_library\(.*?PUBLIC(.*?)PRIVATE", text, re.M | re.S)[1]
    return [f"{module}/{name}" for name in public.split()]


def _escaped(text: str) -> str:
    """Words for doxygen, in which < is no tag."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if k % 2 else part.replace("<", "&lt;").replace(">", "&gt;") for k, part in enumerate(parts))


def _for_doxygen(text: str, group: str, title: str) -> str:
    """A header with all that it declares in a group; remarks behind members are their texts."""
    head, inside, body = re.match(r"(.*?)(^namespace [\w:]+ \{\n)(.*)", text, re.M | re.S).groups()
    about = "\n".join(line for line in head.splitlines() if line.startswith("///"))
    includes = "\n".join(line for line in head.splitlines() if line.startswith("#include"))
    body = re.sub(r"^}  // namespace", "/// @}\n}  // namespace", body, flags=re.M)
    lines, behind = [], False
    for line in body.splitlines():
        if re.match(r"\s*friend [\w<>]+;", line):  # is no part of what users see
            continue
        remark = re.match(r"(\s*[^/\s].*[;,]) +//(?!/) ?(.*)", line)
        more = re.match(r"\s{12,}//(?!/) ?(.*)", line)
        if remark:
            line, behind = f"{remark[1]}  ///< {remark[2]}", True
        elif behind and more:
            line = f"    ///< {more[1]}"
        else:
            behind = False
        line = re.sub(r"(?<=\d)'(?=\d)", "", line)  # digits in groups, and named parts, are not C++ to Sphinx 5
        line = re.sub(r"\s*(= )?\{\.[^;]*\};", ";", line)
        comment = re.match(r"(.*?)(///.*)", line)
        lines.append(comment[1] + _escaped(comment[2]) if comment else line)
    group_begins = f"/// @defgroup {group} {title}\n{_escaped(about)}\n/// @{{\n"
    return f"#pragma once\n{includes}\n{inside}{group_begins}" + "\n".join(lines) + "\n"


def _paragraphs(element: ElementTree.Element | None) -> list[str]:
    """What a comment says, as text of Sphinx's."""
    found = [" ".join("".join(part.itertext()).split()) for part in element] if element is not None else []
    return [re.sub(r"([*`_|\\])", r"\\\1", words) for words in found if words]


def _named(xml: pathlib.Path, group: str) -> tuple[list[str], list[str]]:
    """What a header is about and declares. Names in its group's XML become whole ones, as breathe takes them."""
    path = xml / f"group__{group.replace('_', '__')}.xml"
    tree = ElementTree.parse(path)
    names = [element.text or "" for element in tree.iter("innerclass")]
    for member in tree.iter("memberdef"):
        whole = member.findtext("qualifiedname") or ""
        names.append(whole)
        member.find("name").text = whole
    tree.write(path, encoding="utf-8", xml_declaration=True)
    about = tree.find("compounddef/detaileddescription")
    inner = {name for name in names if any(name.startswith(other + "::") for other in names)}
    top = {name for name in names if "::operator" not in name} - inner
    return _paragraphs(about), sorted(top)


def pages(root: pathlib.Path, work: pathlib.Path, out: pathlib.Path) -> None:
    """Writes a page for each folder of each module, and one that says where all names are."""
    out.mkdir(parents=True)
    folders: dict[str, list[tuple[str, str]]] = {}
    for module in ("dynamics", "markov", "lattice"):
        for header in _installed(root, module):
            path = pathlib.PurePosixPath(header)
            if path.stem == module:  # includes the others
                continue
            group = re.sub(r"\W", "_", str(path.with_suffix("")))
            copy = work / header
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(_for_doxygen((root / header).read_text(encoding="utf-8"), group, header), encoding="utf-8")
            folders.setdefault(str(path.parent), []).append((group, header))
    (work / "Doxyfile").write_text(DOXYFILE, encoding="utf-8")
    subprocess.run(["doxygen", "Doxyfile"], cwd=work, check=True)
    index = [INDEX]
    for folder, headers in folders.items():
        title, page = f"{folder}/", folder.replace("/", "_")
        text = [title, "=" * len(title), "", f"``namespace gatewalk::{folder.split('/')[0]}``", ""]
        index += [title, "-" * len(title), "", f"All of it: :doc:`{page}`.", ""]
        index += [".. list-table::", "   :widths: 30 70", ""]
        for group, header in sorted(headers):
            about, names = _named(work / "xml", group)
            text += [header, "-" * len(header), "", *(f"{words}\n" for words in about), f".. doxygengroup:: {group}",
                     "   :content-only:", "   :members:", "   :undoc-members:", ""]
            about = re.split(r"(?<=\.) ", " ".join(about))[0]
            links = ", ".join(f":cpp:any:`{name.rpartition('::')[2]} <{name}>`" for name in names)
            index += [f"   * - ``{header}``", f"     - {about}", "", f"       {links}"]
        index += [""]
        (out / f"{page}.rst").write_text("\n".join(text), encoding="utf-8")
    index += [".. toctree::", "   :hidden:", "", *(f"   {folder.replace('/', '_')}" for folder in folders), ""]
    (out / "index.rst").write_text("\n".join(index), encoding="utf-8")

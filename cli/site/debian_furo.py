# SPDX-License-Identifier: MIT
"""Debian 12's furo as its authors meant it: without a web server its script does not start, a style sheet is looked
for where only a server of Debian has it, and dark pages are lost for readers whose system is dark. A furo without these
faults is left as it is."""

import pathlib
import re
import shutil


def _block(css: str, head: str) -> str | None:
    """What stands in the braces after a selector."""
    at = css.find(head)
    if at < 0:
        return None
    begin = css.index("{", at) + 1
    depth, end = 1, begin
    while depth:
        depth += {"{": 1, "}": -1}.get(css[end], 0)
        end += 1
    return css[begin:end - 1]


def repair(static: pathlib.Path) -> None:
    script = static / "scripts/furo.js"
    text = script.read_text(encoding="utf-8")
    imported = re.match(r'import Gumshoe from "\./([\w.-]+)";\n', text)
    if imported:  # browsers load no modules from files
        needed = (static / "scripts" / imported[1]).read_text(encoding="utf-8")
        script.write_text(needed + text[imported.end():], encoding="utf-8")

    sheet = static / "styles/furo.css"
    css = sheet.read_text(encoding="utf-8")
    served = re.search(r"@import url\((/javascript/[\w./-]+)\);", css)
    if served:
        name = pathlib.Path(served[1]).name
        shutil.copyfile(f"/usr/share{served[1]}", sheet.with_name(name))
        css = css.replace(served[0], f"@import url({name});")
    dark = _block(css, 'body[data-theme="dark"] {')
    if "prefers-color-scheme" not in css and dark is not None:
        css += f'\n@media screen and (prefers-color-scheme: dark) {{ body[data-theme="auto"] {{{dark}}} }}\n'
    sheet.write_text(css, encoding="utf-8")

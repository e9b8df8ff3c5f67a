# SPDX-License-Identifier: MIT
"""Pages that are made of other texts: the program's help, CITATION.cff, a list of notebooks."""

import re
import typing as t

ROFF = {r"\-": "-", r"\(aq": "'", r"\e": "\\", r"\&": "", r"\fB": "", r"\fI": "", r"\fR": ""}


def _plain(text: str) -> str:
    for code, meaning in ROFF.items():
        text = text.replace(code, meaning)
    if re.search(r"\\[^\\]", text.replace("\\\\", "")):
        raise SystemExit(f"a manual page has a code that the site does not know: {text}")
    return text


def _words(text: str) -> str:
    """A manual page's text as Markdown that shows it as it is."""
    return re.sub(r"([*_`<>\[\]#|$~])", r"\\\1", _plain(text))


def command_page(manual: str, name: str) -> str:
    """The page of a command, of its manual page: head, use, what it does, options, example."""
    sections: dict[str, list[str]] = {}
    for line in manual.splitlines():
        if line.startswith(".SH "):
            section = sections.setdefault(line[4:], [])
        elif not line.startswith(".TH "):
            section.append(line)
    what = _plain(" ".join(sections["NAME"])).partition(" - ")[2]
    out = [f"# gatewalk {name}", "", f"{_words(what[0].upper() + what[1:])}.", "", "```"]
    out += [_plain(line.removeprefix(".B ")) for line in sections["SYNOPSIS"]]
    out += ["```", "", f"```{{program}} gatewalk {name}", "```", ""]
    for title in ("DESCRIPTION", "OPTIONS", "EXAMPLE"):
        lines = sections.get(title, [])
        if title != "DESCRIPTION":
            out += [f"## {title.capitalize()}", ""]
        while lines:
            if lines[0] == ".nf":
                end = lines.index(".fi")
                out += ["```", *map(_plain, lines[1:end]), "```", ""]
                lines = lines[end + 1:]
            elif lines[0] == ".TP":
                head, body, lines = lines[1], lines[2], lines[3:]
                if title == "OPTIONS":
                    out += [f"````{{option}} {_plain(head)}", _words(body), "````", ""]
                else:
                    out += ["", f"`{_plain(head.removeprefix('.I '))}`", f": {_words(body)}", ""]
            elif lines[0].startswith(".SS "):
                out, lines = [*out, "", f"### {_plain(lines[0][4:])}", ""], lines[1:]
            elif lines[0].startswith("."):
                out, lines = [*out, ""], lines[1:]
            else:
                out, lines = [*out, _words(lines[0])], lines[1:]
        out.append("")
    out += ["[Options and exit statuses of all commands](../reference/conventions.md).", ""]
    return "\n".join(out)


def commands_page(overview: str) -> str:
    """All commands in the groups of `gatewalk help`."""
    out = ["# Commands", "", "Each page shows what `gatewalk help COMMAND` prints.",
           "[How-to guides](guides/index.md) begin with a question and show the commands that answer it.",
           "[Conventions](reference/conventions.md) explains what all commands share.", ""]
    names = []
    for title, lines in re.findall(r"^(\w.*)\n((?:  [\w-]+(?: \w+)?  +.*\n)+)", overview, re.M):
        out += [f"## {title}", ""]
        for name, what in re.findall(r"^  ([\w-]+(?: \w+)?)  +(.*)$", lines, re.M):
            names.append(name)
            out.append(f"- [{name}](commands/{name.replace(' ', '-')}.md): {what}")
        out.append("")
    out += ["```{toctree}", ":hidden:", "", *(f"{name} <commands/{name.replace(' ', '-')}>" for name in names), "```", ""]
    return "\n".join(out)


def notebooks_page(names: list[str]) -> str:
    out = ["# Notebooks", "", "The site runs each notebook when it is built, so numbers and pictures are those of this version.", ""]
    out += ["```{toctree}", ":maxdepth: 1", "", *(f"notebooks/{name}" for name in names), "```", ""]
    return "\n".join(out)


def _bibtex(kind: str, key: str, fields: dict[str, t.Any]) -> str:
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items()]
    return "\n".join(["```", f"@{kind}{{{key},", *lines, "}", "```"])


def _authors(people: list[dict[str, str]]) -> str:
    def one(who: dict[str, str]) -> str:
        return f"{{{who['name']}}}" if "name" in who else f"{who['family-names']}, {who['given-names']}"

    return " and ".join(map(one, people))


def cite_page(cff: dict[str, t.Any]) -> str:
    """How to cite, of CITATION.cff."""
    program = {"title": cff["title"], "author": _authors(cff["authors"]), "version": cff["version"],
               "license": cff["license"]}
    out = ["# How to cite", "", cff["message"], "", "The program:", "", _bibtex("software", "gatewalk", program)]
    for paper in cff["references"]:
        key = paper["authors"][0]["family-names"].lower() + str(paper["year"])
        fields = {"title": paper["title"], "author": _authors(paper["authors"]), "journal": paper["journal"],
                  "year": paper["year"]}
        out += ["", "The paper:", "", _bibtex(paper["type"], key, fields)]
    return "\n".join([*out, ""])

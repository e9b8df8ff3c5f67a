#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the commands of a page one after the other in this folder, and compares what they print with the page.

    pages.py PAGE            compares; the first difference ends it
    pages.py PAGE --renew    writes into the page what is printed now; status 1 if lines of the page had no counterpart

Blocks of sh and python run as a whole; the text block that follows shows what they print. In a block without a kind
whose first line begins with "$ " each such line is a command, and the lines up to the next one show what it prints
(errors too). Without such lines anything may be printed. A command must be refused (status 2) if its lines are one that
begins with "gatewalk: " and further ones that are indented; else it must end well. "[...]" stands for anything, on a
line of its own for any lines, at the end of a line also for nothing. A file that the page shows by cat is made unless
it exists.

--renew changes only output that does not match. Output without a line "[...]" is replaced whole. Else each line is
replaced by the next printed line that begins with the same words, up to the first number or bracket; "[...]" stands
where printed lines are left out. A line that ended in "[...]" is cut after as many words as before; so is each line
longer than 110 characters.
"""
import contextlib
import io
import os
import re
import subprocess
import sys
import traceback

path, renew = sys.argv[1], sys.argv[2:] == ["--renew"]
ELSE, WIDEST = "[...]", 110
names, seen, ran, renewed, lost = {}, None, 0, [], []


def fail(text, *rest):
    sys.exit("\n".join([f"{path}: {text}", *rest]))


def as_pattern(shown):
    lines = [r"(?:.*\n)*?" if line.strip() == ELSE else
             ".*".join(map(re.escape, re.sub(r"[ \t]+(?=\[\.\.\.\]$)", "", line.rstrip()).split(ELSE))) + r"[ \t]*\n"
             for line in shown.splitlines()]
    return "".join(lines)


def matches(shown, printed):
    return re.fullmatch(as_pattern(shown), printed) is not None


def label(line):
    """The words that a line begins with, up to its first number or bracket; or its first word."""
    return re.split(r"[\d\[(<]|-(?=\d)", line.strip(), maxsplit=1)[0].split() or line.split()[:1]


def cut(line, words):
    """The line with so many words, or as many as fit, and [...] for the others."""
    ends = [found.end() for found in re.finditer(r"\S+", line)]
    fitting = [end for end in ends[:words] if end <= WIDEST]
    return line if len(fitting) == len(ends) else line[:fitting[-1]] + f" {ELSE}"


def renewal(shown, printed):
    """What the page shows of the printed lines from now on."""
    new = [line.rstrip() for line in printed.splitlines()]
    old = shown.splitlines()
    if not any(line.strip() == ELSE for line in old):
        return "".join(cut(line, len(line)) + "\n" for line in new)
    out, at = [], 0
    for line in old:
        if line.strip() == ELSE:
            continue
        wanted = label(line.split(ELSE)[0])
        there = next((k for k in range(at, len(new)) if wanted and label(new[k])[:len(wanted)] == wanted), None)
        if there is None:
            lost.append(line)
            continue
        if there > at:
            out.append(ELSE)
        ended = line.rstrip().endswith(ELSE)
        if matches(line, new[there] + "\n"):
            out.append(line)
        else:
            out.append(cut(new[there], len(line.split(ELSE)[0].split()) if ended else len(new[there])))
        at = there + 1
    if at < len(new):
        out.append(ELSE)
    return "".join(line + "\n" for line in out)


def compare(shown, printed, begin):
    if matches(shown, printed):
        return
    if not renew:
        fail("the page shows", shown, "but what is printed is", printed)
    renewed.append((begin, shown, renewal(shown, printed)))


def shell(text, errors=subprocess.PIPE, refused=False):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], stdout=subprocess.PIPE, stderr=errors, text=True)
    # head, which has seen enough, ends what writes to it
    if done.returncode not in ([2] if refused else [0, 141]):
        fail(f"exit status {done.returncode}:", text, done.stderr or done.stdout)
    return done.stdout


def console(text, begin):
    for found in re.finditer(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.M):
        command, shown = found.groups()
        file = re.fullmatch(r"cat (\S+)", command)
        if file and not os.path.exists(file[1]):
            with open(file[1], "w", encoding="utf-8") as made:
                made.write(shown)
        refused = re.fullmatch(r"gatewalk: .*\n(?:[ \t].*\n)*", shown) is not None
        printed = shell(command, subprocess.STDOUT, refused)
        # How far a command is, which depends on the machine.
        printed = re.sub(r"^gatewalk: .*: (some [0-9.]+ (s|min|h)|[0-9.]+ %(, .* left)?)\n", "", printed, flags=re.M)
        if shown:
            compare(shown, printed, begin + found.start(2))
        yield command


with open(path, encoding="utf-8") as file:
    page = file.read()
for block in re.finditer(r"^```(\w*)\n(.*?)^```$", page, re.S | re.M):
    kind, text = block.groups()
    if kind == "text":
        if seen is None:
            fail("output without a command before it:", text)
        compare(text, seen, block.start(2))
        seen = None
    elif kind == "sh":
        seen, ran = shell(text), ran + 1
    elif kind == "python":
        out = io.StringIO()
        try:
            with contextlib.redirect_stdout(out):
                exec(compile(text, "python block", "exec"), names)
        except Exception:
            fail("a python block fails:", text, traceback.format_exc())
        seen, ran = out.getvalue(), ran + 1
    elif kind == "" and text.startswith("$ "):
        ran += sum(1 for _ in console(text, block.start(2)))
    elif path.endswith("tutorial.md"):
        fail(f"a block of {kind}: only sh, python and text are run")
if not ran:
    fail("no commands")
for begin, shown, new in reversed(renewed):
    page = page[:begin] + new + page[begin + len(shown):]
if renewed:
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
print(f"{ran} blocks and commands" + (f", {len(renewed)} outputs renewed" if renew else ""))
if lost:
    fail("lines that have no counterpart any more:", *lost)

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pages as they stand: pages.py PAGE runs the commands of a page one after the other, in this folder.

Blocks of sh and python run as a whole, and print the lines of the text block that follows. In a block without a kind
whose first line begins with "$ " each such line is a command, and what is printed (errors too) are the lines up to the
next, where there are any; it is refused (status 2) if and only if they are one line that begins with "gatewalk: ".
"[...]": anything, on a line of its own any lines. A file that is shown by cat and is not there is made.
"""
import contextlib, io, os, re, subprocess, sys, traceback

page = open(sys.argv[1], encoding="utf-8").read()
blocks = re.findall(r"^```(\w*)\n(.*?)^```$", page, re.S | re.M)
names, seen, ran = {}, None, 0


def fail(text, *rest):
    sys.exit("\n".join([f"{sys.argv[1]}: {text}", *rest]))


def as_pattern(shown):
    lines = [r"(?:.*\n)*?" if line.strip() == "[...]" else
             ".*".join(re.escape(part.rstrip() if k == last else part) for k, part in enumerate(line.split("[...]"))) + r"[ \t]*\n"
             for line in shown.splitlines() for last in [line.count("[...]")]]
    return "".join(lines)


def shell(text, errors=subprocess.PIPE, refused=False):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], stdout=subprocess.PIPE, stderr=errors, text=True)
    # head, which has seen enough, ends what writes to it
    if done.returncode not in ([2] if refused else [0, 141]):
        fail(f"exit status {done.returncode}:", text, done.stderr or done.stdout)
    return done.stdout


def compare(shown, printed):
    if not re.fullmatch(as_pattern(shown), printed):
        fail("the page shows", shown, "but what is printed is", printed)


def console(text):
    for command, shown in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.M):
        file = re.fullmatch(r"cat (\S+)", command)
        if file and not os.path.exists(file[1]):
            with open(file[1], "w", encoding="utf-8") as made:
                made.write(shown)
        refused = re.fullmatch(r"gatewalk: .*\n", shown) is not None
        printed = shell(command, subprocess.STDOUT, refused)
        # How far a command is, which depends on the machine.
        printed = re.sub(r"^gatewalk: .*: (some [0-9.]+ (s|min|h)|[0-9.]+ %(, .* left)?)\n", "", printed, flags=re.M)
        if shown:
            compare(shown, printed)
        yield command


for kind, text in blocks:
    if kind == "text":
        if seen is None:
            fail("output without a command before it:", text)
        compare(text, seen)
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
        ran += sum(1 for _ in console(text))
    elif sys.argv[1].endswith("tutorial.md"):
        fail(f"a block of {kind}: only sh, python and text are run")
if not ran:
    fail("no commands")
print(f"{ran} blocks and commands")

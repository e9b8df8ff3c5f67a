#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The installed headers declare what tests/files/api.txt lists: types with their members, functions, constants. A change
# of the list may break users' programs, and needs a line in CHANGELOG.md.
#   tests/api_test.sh BUILD ROOT [--renew]      --renew: writes the list anew
set -euo pipefail
root=$2 list=$2/tests/files/api.txt
found=$(mktemp)
trap 'rm -f "$found"' EXIT
python3 - "$root" >"$found" <<'END'
import pathlib, re, sys

root = pathlib.Path(sys.argv[1])


def declarations(text):
    """The text of each declaration that others may use, without comments and bodies of functions."""
    text = re.sub(r"//.*|^#.*", "", text, flags=re.M)
    scopes, words, access = [], "", []  # access: of each class that is open, whether its members are public
    i = 0
    while i < len(text):
        c = text[i]
        i += 1
        if c == '"':  # a text of its own, with whatever it has
            end = re.compile(r'(?:[^"\\]|\\.)*"').match(text, i).end()
            words, i = words + text[i - 1 : end], end
        elif c == ":" and (label := re.search(r"\b(public|private|protected)\s*$", words)):
            access[-1], words = label[1] == "public", ""
        elif c == ";":
            if words.strip() and all(access):
                yield "::".join(scopes), " ".join(words.split()) + c
            words = ""
        elif c == "{":
            opened = re.match(r"\s*(?:template\s*<.*>\s*)?(namespace|struct|class)\b([^()=]*)$", words, re.S)
            if opened:
                name = opened[2].split(" : ")[0].split(" final")[0].strip()
                if opened[1] != "namespace" and all(access):
                    yield "::".join(scopes), " ".join(words.split())
                scopes.append(name.removeprefix("gatewalk::"))
                access.append(opened[1] != "class")
                words = ""
                continue
            start, depth = i - 1, 1
            while depth:
                depth += {"{": 1, "}": -1}.get(text[i], 0)
                i += 1
            in_list = re.search(r"\)\s*:\s", words)  # of a constructor's members: (a), b{c}
            if re.search(r"\)[^()=]*$", words) and not (in_list and re.search(r"\w\s*$", words)):  # a function's body
                words = re.sub(r"\)\s*:\s[^:].*$", ")", words, flags=re.S)
                if words.strip() and all(access):
                    yield "::".join(scopes), " ".join(words.split())
                words = ""
            else:
                words += text[start:i]
        elif c == "}":
            if scopes:
                scopes.pop()
                access.pop()
            words = ""
        else:
            words += c


for module in ("dynamics", "markov", "lattice"):
    lists = (root / module / "CMakeLists.txt").read_text()
    headers = re.search(r"^gatewalk_library\(.*?PUBLIC(.*?)PRIVATE", lists, re.M | re.S)[1].split()
    for header in sorted(headers):
        print(f"# {module}/{header}")
        for scope, text in declarations((root / module / header).read_text()):
            if not re.search(r"^(class|struct) \w+;$|^extern |\bfriend\b|= delete;$", text):
                print(f"{scope}: {text.rstrip(';')}")
END
[ "$(wc -l <"$found")" -gt 500 ] || { echo "only $(wc -l <"$found") declarations found in $root"; exit 1; }
if [ "${3-}" = --renew ]; then cp "$found" "$list"; fi
difference=$(diff "$list" "$found") && exit 0
echo "The installed headers have changed (< promised, > found); if that is meant: tests/api_test.sh BUILD ROOT --renew"
echo "$difference"
exit 1

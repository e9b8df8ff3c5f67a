# SPDX-License-Identifier: MIT
"""Arguments of Python as words of a command line, and messages of a command in Python's words."""

from __future__ import annotations

import csv
import decimal
import difflib
import functools
import numbers
import operator
import os
import re
import reprlib
import typing as t

from . import _core

#: Options that have no use in Python, and options that the module sets itself.
_NOT_HERE = {"quiet", "json", "checkpoint", "resume", "max-time", "shard", "part", "output", "help"}
#: The function for each command, by the name of the command.
_FUNCTIONS = {"import": "from_counts", "export": "Matrix.export", "scene": "Scene", **{name: name for name in (
    "analyze", "build", "design", "fit", "gate", "landscape", "lattice", "merge", "passages", "plan", "power", "predict", "rare", "sample",
    "simulate", "sweep", "trace", "validate", "walk")}}


class Option(t.NamedTuple):
    value: str  # as the help page shows it
    kind: str  # flag, count, seed, number, text
    is_file: bool
    is_repeated: bool


@functools.lru_cache(maxsize=None)
def options_of(command: str) -> dict[str, Option]:
    """Options of a command by name. Raises UsageError where there is no such command."""
    return {option[0]: Option(*option[1:]) for option in _core.options(command)}


def refuse(parameter: str, allowed: str, value: t.Any) -> t.NoReturn:
    """Raises a UsageError: the argument is of the wrong kind, and what is allowed."""
    raise _core.UsageError(f"{parameter}: must be {allowed}, not {reprlib.repr(value)}")


def path_of(value: t.Any, parameter: str, allowed: str = "a path") -> str:
    """A path as the program takes it. Raises UsageError if the value is no path."""
    if not isinstance(value, (str, os.PathLike)):
        refuse(parameter, allowed, value)
    path = os.fsdecode(value)
    if not path or "\0" in path:
        refuse(parameter, allowed, value)
    return path


def input_of(value: t.Any, parameter: str, error: type[ValueError] = _core.UsageError, allowed: str = "a path") -> str:
    """The path of an existing file. Raises UsageError if the value is no path, and `error` if there is no such file."""
    path = path_of(value, parameter, allowed)
    if not os.path.exists(path):
        text = "; a text has several lines, a line break at its end will do" if isinstance(value, str) and re.search(r"[=\[{]", value) else ""
        raise error(f"{parameter}: {path}: there is no such file{text}")
    return path


def whole(value: t.Any, what: str, least: int, most: int) -> int:
    """A whole number of Python or numpy. Raises UsageError for anything else, and for a number out of range."""
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise _core.UsageError(f"{what} must be a whole number from {least} to {most}, not {value!r}")
    return number


def plain(value: t.Any) -> t.Any:
    """A value of numpy or pandas as plain Python: booleans, numbers, texts, lists and dicts. Other values stay as they are."""
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple, range)):
        return [plain(x) for x in value]
    if isinstance(value, t.Mapping):
        return {k: plain(v) for k, v in value.items()}
    if isinstance(value, numbers.Integral):
        return value if isinstance(value, bool) else int(value)
    return float(value) if isinstance(value, (numbers.Real, decimal.Decimal)) else value


def _is_number(value: t.Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _word(value: t.Any) -> str:
    """A plain value as it stands on the command line. Raises TypeError if it has no such form."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return ",".join(map(_word, value))
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str) and "\0" not in value:
        return value
    raise TypeError


def _setting(value: t.Any) -> str:
    """The value of a scene key, as it stands on the command line."""
    return f"[{', '.join(map(_setting, value))}]" if isinstance(value, list) else _word(value)


def _range(value: t.Any) -> str:
    """A range (low, high), as it stands on the command line."""
    if isinstance(value, str) and re.fullmatch(rf"{_NUMBER}:{_NUMBER}", value):
        value = [float(end) for end in value.split(":")]
    if not isinstance(value, list) or len(value) != 2 or not all(map(_is_number, value)) or not value[0] < value[1]:
        raise TypeError
    return ":".join(map(_word, value))


def _start(value: t.Any) -> str:
    """A start as it stands on the command line: coordinates, with or without a face in front, or a state."""
    def is_number(one: t.Any) -> bool:  # numpy makes texts of numbers beside a text
        return _is_number(one) or isinstance(one, str) and re.fullmatch(_NUMBER, one) is not None

    if isinstance(value, list) and len(value) > 1 and isinstance(value[0], str) and all(map(is_number, value[1:])):
        return f"{value[0]}:{_word(value[1:])}"
    return _word(value)


#: Options whose value is a dict: how an item is written behind "=", and an example.
_DICTS: dict[str, tuple[t.Callable[[t.Any], str], str]] = {
    "set": (_setting, '{"forces.random_N": 20}'),
    "versus": (_setting, '{"forces.random_N": 20}'),
    "vary": (_word, '{"forces.random_N": [10, 20, 30]} or {"forces.random_N": "10:5:30"}'),
    "over": (_range, '{"forces.random_N": (10, 30)}, the low one first'),
    "free": (_range, '{"forces.random_N": (10, 30)}, the low one first'),
    "columns": (_word, '{"x": "POSITION_X", "y": "POSITION_Y"}'),
}
#: What other options take, where the help page does not say it.
_OTHERS = {"matrix": "a Matrix or the path of one", "starts": "'all', or a (low, high) each of d, vx and vy",
           "start": '(d, vx, vy), (face, s, vx, vy), the number or name of a state, or a list or array of these (of a DataFrame .to_numpy())',
           "versus": f"a dict such as {_DICTS['versus'][1]}, or of recorded runs another Matrix or the path of one",
           "first-passage": "an ending, a gate (i_x, i_y), a state, or a state of one gate (i_x, i_y, state)"}


def _allowed(name: str, option: Option) -> str:
    if name in _DICTS or name in _OTHERS:
        return _OTHERS.get(name) or f"a dict such as {_DICTS[name][1]}"
    if option.is_file:
        return f"the path of a file, {option.value}"
    if option.kind != "text":
        return {"flag": "True or False", "count": "a whole number", "seed": "a whole number from 0", "number": "a number"}[option.kind]
    words = [repr(word) if word.islower() else f"({word.replace(',', ', ').lower()})" if re.fullmatch("[A-Z]+(,[A-Z]+)+", word) else word
             for word in option.value.split("|")]
    return " or ".join(words) + (", or a list of these" if option.is_repeated else "")


def _of_dict(name: str, key: str, value: dict[t.Any, t.Any]) -> list[str]:
    of_item, example = _DICTS[name]
    items = []
    for k, v in value.items():
        try:
            items.append(f"{k}={of_item(v)}" if isinstance(k, str) and k else _word(None))
        except TypeError:
            raise _core.UsageError(f"{key}: {reprlib.repr(k)}: {reprlib.repr(v)} is not permitted: must be as in {example}") from None
    if name != "columns":
        return items
    return [",".join('"' + item.replace('"', '""') + '"' for item in items)]


def _values_of(name: str, key: str, option: Option, given: t.Any) -> list[str]:
    """The texts behind "=", one for each time that the option is given."""
    from ._matrix import Matrix

    value = given._path if isinstance(given, Matrix) and name in ("matrix", "versus") else plain(given)
    if isinstance(value, dict) and name in _DICTS:
        return _of_dict(name, key, value)
    is_list, is_file = isinstance(value, list), option.is_file and name not in _DICTS
    is_single = (is_file or option.kind != "text") and not option.is_repeated
    if isinstance(value, bool) or (is_list and is_single) or (_is_number(value) and (is_file or name in _DICTS)):
        refuse(key, _allowed(name, option), given)
    if is_list and not value:
        raise _core.UsageError(f"{key}: is empty; must be {_allowed(name, option)}")
    # Numbers belong together, (d, vx, vy), behind a face too; of a list of lists each is one.
    behind_face = value[1:] if is_list and name == "start" and isinstance(value[0], str) and len(value) > 1 else value
    several = is_list and option.is_repeated and not (option.kind == "text" and all(map(_is_number, behind_face)))
    try:
        if is_list and not several and all(isinstance(one, list) for one in value):
            return [",".join(map(_range, value))]
        return [(_start if name == "start" else _word)(one) for one in (value if several else [value])]
    except TypeError:
        refuse(key, _allowed(name, option), given)


def words_of(command: str, given: dict[str, t.Any]) -> list[str]:
    """Keyword arguments as options. Raises UsageError for an unknown keyword, and for a value of the wrong kind."""
    offered = options_of(command)
    words: list[str] = []
    for key, value in given.items():
        name = key.replace("_", "-")
        if value is None:
            continue
        if name in _NOT_HERE:
            raise _core.UsageError(f"{key}: has no meaning in Python, the program alone has such an option")
        if name == "threads":
            raise _core.UsageError("threads: gatewalk.threads(n) sets them, for all that follows")
        option = offered.get(name)
        if option is None and name != "set":
            meant = difflib.get_close_matches(name, set(offered) - _NOT_HERE, 1)
            raise _core.UsageError(f"there is no parameter {key}=" + (f" (did you mean {meant[0].replace('-', '_')}=?)" if meant else "")
                                   + f"; gatewalk.options({command!r}) lists all")
        option = option or Option("KEY=VALUE", "text", False, True)  # the command says why it takes none
        if option.kind == "flag":
            flag = plain(value)
            if not isinstance(flag, bool):
                refuse(key, _allowed(name, option), value)
            words += [f"--{name}"] if flag else []
        else:
            words += [f"--{name}={text}" for text in _values_of(name, key, option, value)]
    return words


# ---- Messages of a command ----

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLACEHOLDER = r"[A-Z][A-Z0-9/|]*(?:\.[a-z|0-9]+)?"
#: A word that is the value of the option in front of it, such as KEY=VALUE in a message.
_VALUE = re.compile(rf"{_NUMBER}(?:[,:]{_NUMBER})*|[A-Z]+(?:,[A-Z]+)+|{_PLACEHOLDER}|[\w.]+=\S+|all|auto|seen|[\w./~-]+\.(?:toml|nc|csv|json)")
_NEXT = r"""(?:'[^']*'|"[^"]*"|[^\s'"]+)"""
_OPTION = rf"(?<![\w./-])--(?P<name>[a-z][a-z0-9]*(?:-[a-z0-9]+)*)(?:(?P<mark>[ =])(?P<next>{_NEXT}))?"
_CALL = re.compile(rf"\bgatewalk (?P<command>[a-z-]+)(?P<rest>(?: (?:[A-Z][A-Z|]*(?:\.\w+)?\b|-o \S+|--[a-z][a-z-]*(?:[ =](?:{_VALUE.pattern}))?))*)")


def _literal(text: str) -> str:
    """A value of the command line, written as in Python."""
    if re.fullmatch(rf"{_NUMBER}|{_PLACEHOLDER}|\.\.\.|\[.*\]", text):
        return text
    if re.fullmatch(rf"{_NUMBER}(?:,{_NUMBER})+|[A-Z]+(?:,[A-Z]+)+", text):
        return f"({text.replace(',', ', ')})"
    return {"true": "True", "false": "False"}.get(text) or repr(text.strip("'\""))


def _spelled(name: str, text: str) -> str:
    """An option and its value, written as a keyword argument."""
    key = name.replace("-", "_")
    if name == "start" and (place := re.fullmatch(rf"([^:]+):({_NUMBER}(?:,{_NUMBER})*)", text)):
        return f"start=({place[1]!r}, {place[2].replace(',', ', ')})"
    if name not in _DICTS or "=" not in text:
        return f"{key}={_literal(text)}"
    items = []
    for item in next(csv.reader([text])) if name == "columns" else [text]:
        k, _, v = item.strip('"').partition("=")
        low, _, high = v.partition(":")
        is_name = name == "columns" and v != "..." and not re.fullmatch(_NUMBER, v)
        value = repr(v) if is_name else f"({_literal(low)}, {_literal(high)})" if high and name in ("over", "free") else _literal(v)
        items.append(f"{k if k == 'KEY' else repr(k)}: {value}")
    return f"{key}={{{', '.join(items)}}}"


def _known(command: str, name: str) -> Option:
    for one in (command, *_FUNCTIONS):
        try:
            if name in options_of(one):
                return options_of(one)[name]
        except _core.UsageError:  # a command that is not there
            continue
    return Option("", "text", False, False)


def _of_options(text: str, command: str) -> str:
    def said(match: re.Match[str]) -> str:
        name, mark, behind = match["name"], match["mark"] or "", match["next"] or ""
        option = _known(command, name)
        value = re.sub(r"[:;,.)?]+$", "", behind) if not behind.endswith("...") else behind
        is_value = option.kind != "flag" and bool(value) and (
            mark == "=" or bool(_VALUE.fullmatch(value)) or value in option.value.split("|") or value[0] in "'\"")
        rest = behind[len(value):] if is_value else mark + behind
        if name in _NOT_HERE:
            return f"the program's option {name}" + rest
        if name == "threads":
            return "threads" + rest
        if is_value:
            return _spelled(name, value) + rest
        is_subject = match.string[match.end("name"):match.end("name") + 1] == ":"
        return name.replace("-", "_") + ("" if is_subject else "=True" if option.kind == "flag" else "=") + rest

    # What follows an option may be another one.
    before = None
    while before != text:
        before, text = text, re.sub(_OPTION, said, text)
    return text


def _face_in_front(match: re.Match[str]) -> str:
    names, units, faces = match.groups()
    return f"numbers {names} ({units}), with a face in front unless it is the first: ({faces.split(' or ')[0]!r}, {names.replace(',', ', ')}), of {faces}"


#: Other phrases that differ in Python.
_SENTENCES: list[tuple[str, str | t.Callable[[re.Match[str]], str]]] = [
    ("two numbers with a comma between", "two numbers, (X, Y)"),
    (r"\bIX,IY(,STATE)?\b", lambda m: "(IX, IY, STATE)" if m[1] else "(IX, IY)"),
    (r"must be KEY=LOW:HIGH", "must be {KEY: (LOW, HIGH)}"),
    (r"\{KEY: 'from:step:to'\}|\bkey=from:step:to or key=value,value", "{KEY: [VALUE, ...]}"),
    (r"must be seen, or", "must be 'seen', or"),
    (r"numbers (\S+) \(([^)]*)\), behind a face (.+) and a colon unless it is the first", _face_in_front),
]
#: The meaning of a column, where a message names it outside of --columns.
_MEANING = r"(?P<option>--columns[ =]\S+)|(?<![\w-])(?P<name>body|frame|time|x|y|confidence)=(?P<column>\.\.\.|[\w ]*\*\w*|(?=[ )]))(?P<comma>,(?=\w+=))?"


def in_python(text: str, command: str, words: t.Sequence[str] = ()) -> str:
    """A message of a command, with options as keyword arguments and commands as functions. `words`: the command line."""
    for word in sorted((w for w in words if w.startswith("--") and "=" in w), key=len, reverse=True):
        name, _, value = word[2:].partition("=")
        if value and name not in _NOT_HERE:
            said = re.escape(f"--{name}") + "[ =]" + re.escape(value) + r"(?![\w.])"
            text = re.sub(said, lambda _, spelled=_spelled(name, value): spelled, text)  # type: ignore[misc]

    def call(match: re.Match[str]) -> str:
        command, rest = match["command"], match["rest"]
        function = _FUNCTIONS.get(command)
        if function is None:
            return match[0]
        if rest == " --help":
            return f"gatewalk.options({command!r})"
        if rest.startswith(" TABLE"):
            function = "from_passages"
        said, rest = [], re.sub(r" -o \S+", "", rest)
        for part in re.findall(r"--[a-z][a-z-]*(?:[ =](?!--)[^ ]+)?|[^ ]+", rest):
            keyword = _of_options(part, command)
            said.append(keyword + ("..." if keyword.endswith("=") else "") if part.startswith("--") else part.split(".")[0].lower())
        return f"gatewalk.{function}" + (f"({', '.join(said)})" if said else "")

    def meaning(match: re.Match[str]) -> str:
        column = match["column"]
        return match[0] if match["option"] else repr(match["name"]) + (f": {_literal(column)}" if column else "") + (", " if match["comma"] else "")

    text = re.sub(_MEANING, meaning, text) if command in ("passages", "fit") else text
    text = re.sub(r"(?:export )?((?:--[a-z-]+ )+)-o (FILE\.\w+)",
                  lambda m: f"export({m[2]!r}, {', '.join(flag[2:] + '=True' for flag in m[1].split())})", text)
    text = re.sub(r"\bgatewalk ([a-z-]+) --help", lambda m: f"gatewalk.options({m[1]!r})", text)
    text = _of_options(_CALL.sub(call, text), command)
    for said, in_words in _SENTENCES:
        text = re.sub(said, in_words, text)
    text = re.sub(r"(?<=must be )all\b|(?<=, or )all\b|(?<=\()all(?=:)", "'all'", text)
    output = "path" if command == "export" else "the program's option output"
    return re.sub(r"(?<![\w-])-o(?=[ :,;.)]|$)", output, text)

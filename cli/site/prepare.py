# SPDX-License-Identifier: MIT
"""Makes the sources of the documentation site: all pages in one folder, as Sphinx reads them.

    prepare.py ROOT PROGRAM SOURCE [NOTEBOOKS]

ROOT is the repository, PROGRAM the built gatewalk, SOURCE the folder to make, NOTEBOOKS a folder with executed
notebooks as pages. Every Markdown file of the repository is a page: those in cli/site at the top of the site, a README
as index.md in its folder. A file that a page links to, and that is no page, is copied.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import yaml

import cpp
import text_of

PICTURES = {".svg", ".gif", ".png"}


def tracked(root: pathlib.Path) -> list[str]:
    """All pages of the repository, by their paths from its root."""
    git = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
                         capture_output=True, text=True, check=False)
    if git.returncode == 0:
        found = [name for name in git.stdout.split("\0") if name and (root / name).exists()]
    else:  # an archive of the sources
        found = [str(path.relative_to(root)) for path in root.rglob("*.md") if "node_modules" not in path.parts
                 and not path.relative_to(root).parts[0].startswith("build")]
    return sorted(found)


def place_of(page: str) -> str:
    """Where a page of the repository stands on the site."""
    path = pathlib.PurePosixPath(page)
    if path.is_relative_to("cli/site"):
        path = path.relative_to("cli/site")
    return str(path.with_name("index.md") if path.name == "README.md" else path)


def with_links(root: pathlib.Path, page: str, text: str, places: dict[str, str], source: pathlib.Path) -> str:
    """A page's text with its links as they are on the site. What it links to beside pages is copied."""
    here = pathlib.PurePosixPath(page).parent
    place = pathlib.PurePosixPath(places[page]).parent

    def link(match: re.Match[str]) -> str:
        target, _, anchor = match["target"].partition("#")
        if not target or re.match(r"[a-z]+:", target) or (source / place / target).is_file():
            return match[0]
        path = os.path.normpath(here / target)
        if (root / path).is_dir():
            path = os.path.join(path, "README.md")
        if not (root / path).is_file():
            raise SystemExit(f"{page}: a link to {match['target']}, which is not in the repository")
        if path not in places:
            copy = source / path
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / path, copy)
        return f"]({os.path.relpath(places.get(path, path), place)}{'#' + anchor if anchor else ''})"

    # Code is no place for links: fences, and words in backticks.
    parts = re.split(r"(^```.*?^```$|`[^`\n]+`)", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if k % 2 else re.sub(r"\]\((?P<target>[^()\s]+)\)", link, part) for k, part in enumerate(parts))


def write(path: pathlib.Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def commands(program: pathlib.Path, work: pathlib.Path, source: pathlib.Path) -> None:
    """A page for each command, of the manual pages that the program writes, and one that lists them."""
    subprocess.run([program, "help", "--write", work], check=True)
    for manual in sorted((work / "man/man1").glob("gatewalk-*.1")):
        name = manual.stem.removeprefix("gatewalk-")
        write(source / "commands" / f"{name}.md", text_of.command_page(manual.read_text(encoding="utf-8"), name))
    overview = subprocess.run([program, "help"], capture_output=True, text=True, check=True).stdout
    write(source / "commands.md", text_of.commands_page(overview))


def gallery(root: pathlib.Path, program: pathlib.Path, work: pathlib.Path, source: pathlib.Path) -> None:
    """Figures, each with its command, which is run here unless the figure names a picture of results/."""
    work.mkdir(parents=True)
    (work / "scenes").symlink_to(root / "scenes")
    environment = {**os.environ, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}
    page = tomllib.loads((root / "cli/site/gallery.toml").read_text(encoding="utf-8"))
    out = [f"# Gallery\n\n{page['words']}\n"]
    (source / "gallery").mkdir(parents=True)
    for figure in page["figure"]:
        if "picture" in figure:
            picture = root / figure["picture"]
        else:
            for command in figure["commands"]:
                done = subprocess.run(["sh", "-ec", command + " --quiet"], cwd=work, env=environment,
                                      capture_output=True, text=True, check=False)
                if done.returncode != 0:
                    raise SystemExit(f"cli/site/gallery.toml: {command}: {done.stderr}")
            picture = work / figure["file"]
        # One of results/ may have the name of another.
        name = "-".join(picture.relative_to(root if "picture" in figure else work).parts)
        shutil.copyfile(picture, source / "gallery" / name)
        out.append(f"## {figure['title']}\n\n{figure['words']}\n\n![{figure['title']}](gallery/{name})\n\n```\n"
                   + "\n".join(figure["commands"]) + "\n```\n")
    write(source / "gallery.md", "\n".join(out))


def main() -> None:
    root, program, source = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    folder = pathlib.Path(sys.argv[4]).resolve() if len(sys.argv) > 4 else None
    work = source.with_name("work")
    for old in (source, work):
        shutil.rmtree(old, ignore_errors=True)
    texts = {page: (root / page).read_text(encoding="utf-8") for page in tracked(root)}
    places = {page: place_of(page) for page in texts}
    if folder is not None:  # pictures lie beside pages
        shutil.copytree(folder, source / "notebooks")
        for path in sorted(folder.glob("*.md")):
            notebook = f"cli/site/notebooks/{path.stem}.ipynb"
            # pandas' style of a table has empty lines, behind which Markdown takes it for text.
            text = path.read_text(encoding="utf-8")
            texts[notebook] = re.sub(r"<style scoped>.*?</style>\n", "", text, flags=re.DOTALL)
            places[notebook] = f"notebooks/{path.name}"
        write(source / "notebooks.md", text_of.notebooks_page([path.stem for path in sorted(folder.glob("*.md"))]))
    for page, text in texts.items():
        write(source / places[page], with_links(root, page, text, places, source))
    commands(program, work / "help", source)
    gallery(root, program, work / "gallery", source)
    cpp.pages(root, work / "headers", source / "cpp")
    write(source / "cite.md", text_of.cite_page(yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))))
    contents = (root / "cli/site/contents.txt").read_text(encoding="utf-8")
    for page in ("tutorial", "notebooks"):  # where there are none yet
        if not (source / f"{page}.md").exists():
            contents = contents.replace(f"{page}\n", "")
    with open(source / "index.md", "a", encoding="utf-8") as front:
        front.write("\n" + contents)


if __name__ == "__main__":
    main()

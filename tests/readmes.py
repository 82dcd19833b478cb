#!/usr/bin/python3
"""Whether every source file is named in the README of its folder, or of one above it: readmes.py SOURCES

A name in backticks stands for the files that are called so, with any ending, and for those whose names go on after it with an
underscore: csv_parse.cpp is named by `csv_parse.cpp`, `csv_parse`, `csv` and `csv*`. `parts/` stands for the files of that folder.
"""
import pathlib
import re
import sys

FOLDERS = ("campaign", "cli", "data", "dem", "surrogate", "uq")


def names_in(readme):
    if not readme.exists():
        return set()
    words = {word for text in re.findall(r"`([^`]+)`", readme.read_text()) for word in re.split(r"[\s,]+", text)}
    return {word if word.endswith("/") else re.sub(r"\.\w+$|\.?\*$", "", word).rstrip("_") for word in words}


def is_named(file, names):
    return f"{file.parent.name}/" in names or any(name and (file.stem == name or file.stem.startswith(name + "_")) for name in names)


def main():
    root = pathlib.Path(sys.argv[1])
    lacking = []
    for file in sorted(file for folder in FOLDERS for ending in ("hpp", "cpp") for file in (root / folder).rglob(f"*.{ending}")):
        above = [folder for folder in file.parents if folder.is_relative_to(root) and folder != root]
        if not is_named(file, set().union(*(names_in(folder / "README.md") for folder in above))):
            lacking.append(str(file.relative_to(root)))
    print("\n".join(f"{file}: is named in no README" for file in lacking))
    return 1 if lacking else 0


if __name__ == "__main__":
    sys.exit(main())

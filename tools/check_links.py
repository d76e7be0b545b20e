#!/usr/bin/env python3
"""Checks the links in all Markdown pages to files and headings, in the repository or in another FOLDER, such as that of an installed
copy. Exit status 1: a link is broken."""
import os
import re
import sys

ROOT = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
LINK = re.compile(r"(?<!\\)\[[^\]\n]*\]\(([^)\s]+)\)")
SKIPPED = ("build", ".git", "node_modules")


def pages():
    for folder, folders, files in os.walk(ROOT):
        folders[:] = sorted(f for f in folders if f not in SKIPPED)
        yield from (os.path.join(folder, name) for name in sorted(files) if name.endswith(".md"))


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))


def anchors(page):
    """Heading anchors in GitHub's form."""
    with open(page, encoding="utf-8") as file:
        text = re.sub(r"^```.*?^```$", "", file.read(), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ +(.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", h).lower()).replace(" ", "-") for h in headings}


def problems_of(page):
    with open(page, encoding="utf-8") as file:
        text = without_code(file.read())
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, heading = target.partition("#")
        there = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(there):
            yield f"{os.path.relpath(page, ROOT)}: {target} is not there"
        elif heading and there.endswith(".md") and heading not in anchors(there):
            yield f"{os.path.relpath(page, ROOT)}: {target}: there is no such heading"


def main():
    found = [problem for page in pages() for problem in problems_of(page)]
    print("\n".join([*found, f"check_links: {len(found)} problems"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

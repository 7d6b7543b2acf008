#!/usr/bin/env python3
"""Every link of a document leads to a file that is there, every `docs/...md` that a source file names is one, and a
section that is named behind it, as in docs/theory/numerics.md, "Boxes", is in it.

    check_links.py REPOSITORY
"""
import os
import re
import sys

root = sys.argv[1]
skipped = {"build", ".git", "third_party"}
wrong = []
checked = 0


def text_of(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def has_section(document, name):
    """As a heading, or as the bold or slanted words at the beginning of a paragraph or item."""
    words = r"\s+".join(re.escape(word) for word in name.split())
    return re.search(rf"(^#+ |\*|`){words}", text_of(document), re.MULTILINE)


for folder, folders, names in os.walk(root):
    folders[:] = [f for f in folders if f not in skipped]
    for name in names:
        path = os.path.join(folder, name)
        here = os.path.relpath(path, root)
        if not re.search(r"\.(md|cpp|hpp|h|glsl|comp|py|sh|txt|cmake)$", name) or name == "CHANGELOG.md":
            continue
        text = text_of(path)
        named = [(m, os.path.join(root, m.group())) for m in re.finditer(r"\bdocs/[a-z_0-9/]+\.md", text)]
        if name.endswith(".md"):
            for match in re.finditer(r"\]\(([^)\s]+)\)", text):
                url = match.group(1).partition("#")[0]
                if url and not re.match(r"[a-z]+:", url):
                    named.append((match, os.path.join(folder, url)))
        for match, document in named:
            checked += 1
            if not os.path.exists(document):
                wrong.append(f"{here}: {match.group()}")
                continue
            after = re.sub(r"\s*\n\s*(///|//|#)?\s*", " ", text[match.end() : match.end() + 200])
            section = re.match(r'\)?, "([^"]+)"', after)
            if section and document.endswith(".md") and not has_section(document, section.group(1)):
                wrong.append(f'{here}: {match.group()} has no "{section.group(1)}"')

for line in wrong:
    print(line, "is not there")
print(f"{checked} references")
sys.exit(1 if wrong or checked < 100 else 0)

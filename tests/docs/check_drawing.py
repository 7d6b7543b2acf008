#!/usr/bin/env python3
"""check_drawing.py ARCHITECTURE.md LAYERS.txt

Whether the drawing of the libraries is true: each arrow stands for what a library names in its
CMakeLists.txt (layers.txt has all of that), and whatever one names follows from the arrows.
"""
import re
import sys

LEFT_OUT = {"host/version"}  # named by nearly all, names nothing


def drawing_in(text):
    return re.search(r"```mermaid\n(.*?)```", text, re.S).group(1)


def nodes_in(drawing):
    """The node of each folder: `build[scene/build, xml, images]` stands for three of scene."""
    nodes = {"scene": "scene"}
    for node, label in re.findall(r"(\w+)\[([^]]*)\]", drawing):
        first, *others = label.split(", ")
        parent = first.rsplit("/", 1)[0]
        nodes |= {folder: node for folder in [first, *(f"{parent}/{name}" for name in others)]}
    return nodes


def node_of(folder, nodes):
    if folder in nodes:
        return nodes[folder]
    if not folder.startswith("host/"):
        sys.exit(f"{folder} is not in the drawing: it wants a node, or a place in the label of one")
    return folder.removeprefix("host/")


def drawn_arrows(drawing):
    arrows = set()
    for line in re.sub(r"\[[^]]*\]", "", drawing).splitlines():
        if "-->" not in line:
            continue
        start, ends = line.split("-->")
        arrows |= {(start.strip(), end.strip()) for end in ends.split("&")}
    return arrows


def named_arrows(text, nodes):
    rows = [line.split("|") for line in text.splitlines() if line]
    node = {row[0]: node_of(row[1], nodes) for row in rows if row[1] not in LEFT_OUT}
    arrows = set()
    for name, _, public, private in rows:
        for other in (public + "," + private).split(","):
            ends = (node.get(name), node.get(other))
            if all(ends) and ends[0] != ends[1]:
                arrows.add(ends)
    return arrows


def reachable(arrows, start):
    found, left = set(), [start]
    while left:
        one = left.pop()
        for a, b in arrows:
            if a == one and b not in found:
                found.add(b)
                left.append(b)
    return found


def main():
    drawing = drawing_in(open(sys.argv[1], encoding="utf-8").read())
    drawn = drawn_arrows(drawing)
    named = named_arrows(open(sys.argv[2], encoding="utf-8").read(), nodes_in(drawing))
    wrong = [f"{a} --> {b} is drawn, and {a} does not name {b}" for a, b in sorted(drawn - named)]
    for a, b in sorted(named):
        if b not in reachable(drawn, a):
            wrong.append(f"{a} names {b}, which does not follow from the arrows")
    print("\n".join(wrong) or f"{len(drawn)} arrows stand for {len(named)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

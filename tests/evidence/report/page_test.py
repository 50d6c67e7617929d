# SPDX-License-Identifier: MIT
"""Reads a report as strictly as XML is read and checks how it is built: page_test.py PAGE.html"""

import sys
import xml.etree.ElementTree as ElementTree

XHTML, SVG = "{http://www.w3.org/1999/xhtml}", "{http://www.w3.org/2000/svg}"


def check(what, is_true):
    if not is_true:
        sys.exit(f"{sys.argv[1]}: {what}")


def words(element):
    return " ".join("".join(element.itertext()).split())


def check_headings(body):
    levels = [int(e.tag[-1]) for e in body.iter() if e.tag in [XHTML + f"h{k}" for k in range(1, 7)]]
    check("one h1, and first", levels.count(1) == 1 and levels[0] == 1)
    for before, after in zip(levels, levels[1:]):
        check(f"h{after} after h{before}", after <= before + 1)


def check_tables(body):
    for table in body.iter(XHTML + "table"):
        caption = table.find(XHTML + "caption")
        check("a caption of every table", caption is not None and words(caption))
        columns = table.findall(f"{XHTML}thead/{XHTML}tr/{XHTML}th")
        check("column headers", columns and all(c.get("scope") == "col" and words(c) for c in columns))
        rows = table.findall(f"{XHTML}tbody/{XHTML}tr")
        check(f"rows of {words(caption)}", rows)
        for row in rows:
            check(f"a header of every row of {words(caption)}", row[0].tag == XHTML + "th" and row[0].get("scope") == "row")
            check(f"as many cells as columns of {words(caption)}", len(row) == len(columns) and all(words(cell) for cell in row))


def check_pictures(body, ids):
    for svg in body.iter(SVG + "svg"):
        names = (svg.get("aria-labelledby") or "").split()
        check("role and names of every chart", svg.get("role") == "img" and len(names) == 2)
        for name in names:
            check(f"{name}: words for those who do not see it", name in ids and words(ids[name]))
        check("one size for all widths", svg.get("viewBox") and not svg.get("width"))
    for image in body.iter(XHTML + "img"):
        check("words for every drawing", image.get("alt"))
        check("the drawing itself", image.get("src", "").startswith("data:image/svg+xml,"))


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = file.read()
    check("HTML", text.startswith("<!DOCTYPE html>\n<html"))
    root = ElementTree.fromstring(text)
    body = root.find(XHTML + "body")
    check("language", root.get("lang") == "en")
    check("title", words(root.find(f"{XHTML}head/{XHTML}title")))

    ids = {}
    for element in root.iter():
        if "id" in element.attrib:
            check(f"id {element.get('id')} twice", element.get("id") not in ids)
            ids[element.get("id")] = element
    for element in root.iter():
        for name, value in element.attrib.items():
            check(f"{element.tag} {name}: empty", value != "" or name == "d")
            check(f"{name}: no event handlers", not name.lower().startswith("on"))
            if name in ["href", "src"]:
                is_here = value.startswith("#") and value[1:] in ids
                check(f"{value[:60]}: not in this page", is_here or value.startswith("data:image/svg+xml,"))
            if name == "aria-labelledby":
                check(f"{value}: names of what is there", all(part in ids for part in value.split()))
        check(f"no {element.tag}", element.tag.split("}")[-1] not in ["script", "link", "iframe", "object", "base", "form"])
    style = root.find(f"{XHTML}head/{XHTML}style").text
    check("nothing fetched by the style sheet", "url(" not in style and "@import" not in style)

    check_headings(body)
    check_tables(body)
    check_pictures(body, ids)
    shown = words(body)
    for word in ["nan", "inf"]:
        check(f"a number that is {word}", not any(part.strip("().,;:").lower() == word for part in shown.split()))


main()

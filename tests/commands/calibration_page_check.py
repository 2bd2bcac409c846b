#!/usr/bin/env python3
"""calibration_page_check.py PAGE.html GAUGES.json SUMMARY.json: what a page says of a calibration is what the tables say."""
import html.parser
import json
import re
import sys
import xml.etree.ElementTree as ElementTree

XHTML = "{http://www.w3.org/1999/xhtml}"
SVG = "{http://www.w3.org/2000/svg}"


class Balanced(html.parser.HTMLParser):
    """Every element that is opened is closed, as HTML."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"</{tag}> closes nothing"


def numbers(element, name):
    return [float(data.get("value")) for data in element.iter(XHTML + "data") if data.get("class") == name]


def main(page_path, gauges_path, summary_path):
    text = open(page_path, encoding="utf-8").read()
    parser = Balanced()
    parser.feed(text)
    parser.close()
    assert not parser.open, parser.open
    root = ElementTree.fromstring(text)

    gauges = [json.loads(line) for line in open(gauges_path, encoding="utf-8")]
    table = next(each for each in root.iter(XHTML + "table") if each.get("id") == "gauges")
    for column in ("gain", "zero_strain", "angle_offset_deg", "depth_offset_m"):
        for name in (column, "sigma_" + column):
            assert numbers(table, name) == [gauge[name] for gauge in gauges], name
    assert numbers(table, "residual_strain") == [gauge["residual_strain"] for gauge in gauges]

    summary = json.loads(open(summary_path, encoding="utf-8").read())
    reasons = {"weak", "ambiguous", "wide", "over_range", "contradicted", "unexplained"}
    for name in set(summary) - reasons:
        assert numbers(root, name) == [summary[name]], name
    for name in reasons:  # told where there are any
        assert numbers(root, "left-out " + name.replace("_", "-")) == [summary[name]] * (summary[name] > 0), name
    listed = next(each for each in root.iter(XHTML + "table") if each.get("id") == "left-out")
    for row in list(listed)[1:]:
        count, which = row.find(f".//{XHTML}data"), row.find(f"{XHTML}td[@class='words']")
        assert int(count.get("value")) == len(which.text.split(", ")), count.get("class")

    pictures = list(root.iter(SVG + "svg"))
    assert len(pictures) == 3 and all(picture.get("aria-label") for picture in pictures)
    identifiers = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(identifiers) == len(set(identifiers)), "an id is there twice"
    for element in root.iter():
        for name, value in element.attrib.items():
            target = value[1:] if name.endswith("href") else None
            assert target is None or (value.startswith("#") and target in identifiers), value
    assert not re.search(r"(src|href)\s*=\s*[\"'](?!#)|url\((?!#)|@import", text), "something comes from elsewhere"


main(*sys.argv[1:])

"""Reads an HTML page: all tags must match, nothing may be loaded. Prints IDs, number of pictures, and texts."""

import sys
from html.parser import HTMLParser

VOID = {"meta", "link", "br", "hr", "img", "input", "circle", "line", "polyline", "rect"}


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.ids, self.n_pictures, self.texts = [], [], 0, []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("src", "href"):
            assert "//" not in attributes.get(name, ""), f"fetches {attributes[name]}"
        assert tag not in ("script", "link", "iframe", "img"), tag
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag == "svg" and self.open[-1] == "figure":
            self.n_pictures += 1
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        assert tag in VOID, tag

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-1:]}"
        self.open.pop()

    def handle_data(self, data):
        if data.strip():
            self.texts.append(" ".join(data.split()))


page = Page()
page.feed(open(sys.argv[1], encoding="utf-8").read())
page.close()
assert not page.open, f"left open: {page.open}"
assert len(page.ids) == len(set(page.ids)), "an id is used twice"
for it in page.ids:
    print("id", it)
print("pictures", page.n_pictures)
print(" ".join(page.texts))

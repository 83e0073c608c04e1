# SPDX-License-Identifier: Apache-2.0
"""What mkdocs has to know of our pages beyond its configuration."""

import html.parser
import os
import re
import urllib.parse

from mkdocs.exceptions import BuildError


def on_config(config):
    """Every decision and every experiment is a page under its own title."""
    def pages_of(folder):
        names = sorted(os.listdir(os.path.join(config["docs_dir"], folder)))
        return [f"{folder}/{name}" for name in names if name.endswith(".md")]

    sections = {title: pages for section in config["nav"] for title, pages in section.items()}
    sections["What to expect"].append({"Experiments": pages_of("results")})
    sections["How it works"].append({"Decisions": pages_of("decisions")})
    return config


def on_page_markdown(markdown, page, config, files):
    """Files of the source tree beside docs/ are no part of the site: their names stay, links go."""
    up = page.file.src_path.count("/") + 1
    return re.sub(r"\[([^\]]*)\]\((?:\.\./){%d}[^)]*\)" % up, r"\1", markdown)


class Built(html.parser.HTMLParser):
    """A built page: the names that links reach, what it links to, what it loads."""

    def __init__(self, text):
        super().__init__()
        self.names, self.links, self.loads = {""}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.names.add(attributes.get("id", ""))
        if tag == "a" and "href" in attributes:
            self.links.append(attributes["href"])
        elif tag == "link" and attributes.get("rel") != "canonical" or "src" in attributes:
            self.loads.append(attributes.get("href") or attributes.get("src") or "")


def on_post_build(config):
    """Every link leads somewhere within the site, and nothing is loaded from elsewhere."""
    pages = {}
    for folder, _, names in os.walk(config["site_dir"]):
        for path in (os.path.join(folder, name) for name in names if name.endswith(".html")):
            with open(path, encoding="utf-8") as file:
                pages[path] = Built(file.read())
    faults = []
    for path, page in pages.items():
        if os.path.basename(path) == "404.html":  # its links begin at a server's root
            continue
        here = os.path.relpath(path, config["site_dir"])
        for target in page.links + page.loads:
            url = urllib.parse.urlsplit(target)
            if url.scheme:
                if target in page.loads and url.scheme != "data":
                    faults.append(f"{here} loads {target}")
                continue
            file = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(url.path)))
            file = file if url.path else path
            if not os.path.exists(file):
                faults.append(f"{here}: no {target}")
            elif file in pages and urllib.parse.unquote(url.fragment) not in pages[file].names:
                faults.append(f"{here}: no heading {target}")
    if faults:
        raise BuildError("\n".join(faults))

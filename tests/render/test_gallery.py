#!/usr/bin/env python3
"""The gallery of materials: rows of it made small, the page read as a browser would, and by
headless Chromium where that is installed. CDL_SOAK=1 makes all of the rows."""
import base64
import html
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

from support.verdict import check, main, skip

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/gallery.py")
TILE = 16
ONLY = [] if os.environ.get("CDL_SOAK", "0") != "0" else ["--only", "retroreflector"]

# Counts the pictures that were decoded; runs in the browser alone.
PROBE = """<script>addEventListener("load", async () => {
  const all = [...document.images];
  const good = await Promise.all(all.map(i => i.decode().then(() => 1, () => 0)));
  document.title = "decoded " + good.reduce((a, b) => a + b, 0) + " of " + all.length;
})</script>"""


def gallery(*arguments):
    done = subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True,
                          timeout=3600)
    check("gallery.py %s" % " ".join(arguments), done.returncode == 0, done.stderr[-500:])
    return done.stdout


def rows():
    """Heading, caption and labels of each row that the page should have."""
    listed = [line.split(": ", 2) for line in gallery("--list", *ONLY).splitlines()]
    return [(model, caption, labels) for model, caption, labels in listed]


def size_of_png(data):
    """Width and height, with every chunk's sum and all rows there; else None."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return None
    at, pixels, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] != zlib.crc32(kind + body):
            return None
        header = struct.unpack(">IIBB", body[:10]) if kind == b"IHDR" else header
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, depth, color = header
    row = width * {2: 3, 6: 4, 0: 1}[color] * depth // 8 + 1
    return (width, height) if len(zlib.decompress(pixels)) == row * height else None


def check_page(page, expected):
    text = html.unescape(page)
    pictures = re.findall(r'<img width="(\d+)" height="(\d+)" alt="([^"]*)" '
                          r'src="data:image/png;base64,([A-Za-z0-9+/=]+)">', page)
    check("a picture for each row", len(pictures) == len(expected) > 0, str(len(pictures)))
    for width, height, alt, data in pictures:
        size = size_of_png(base64.b64decode(data))
        check("%s: a whole picture" % alt, size == (int(width), int(height)), str(size))
    for model, caption, labels in expected:
        check("%s: heading" % model, "<h2>%s</h2>" % model in text)
        check("%s: caption" % caption, "<figcaption>%s</figcaption>" % caption in text)
        for name in labels.split(", "):
            check("%s: label %s" % (caption, name), name in text)
    links = re.findall(r'(?:src|href)\s*=\s*"(?!data:)[^"]*"|url\(|@import|https?:', page)
    check("nothing from elsewhere", not links, str(links[:3]))


def check_browser(page, folder):
    names = ("chromium", "chromium-browser", "google-chrome", "headless_shell")
    browser = next((found for found in map(shutil.which, names) if found), None)
    if not browser:
        return skip("the page in a browser", "Chromium is not installed")
    path = os.path.join(folder, "probe.html")
    with open(path, "w", encoding="utf-8") as file:
        file.write(page.replace("</body>", PROBE + "</body>"))
    done = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu",
                           "--user-data-dir=" + os.path.join(folder, "profile"),
                           "--virtual-time-budget=20000", "--dump-dom", "file://" + path],
                          capture_output=True, text=True, timeout=300)
    found = re.search(r"<title>decoded (\d+) of (\d+)</title>", done.stdout)
    check("all pictures decode in a browser",
          bool(found) and found.group(1) == found.group(2) != "0",
          found.group(0) if found else done.stderr[-300:])


def test_gallery():
    expected = rows()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "gallery.html")
        gallery("-o", path, "--tile", str(TILE), "--spp", "1", *ONLY)
        if check("there is a page", os.path.exists(path)):
            with open(path, encoding="utf-8") as file:
                page = file.read()
            check_page(page, expected)
            check_browser(page, folder)


if __name__ == "__main__":
    main(test_gallery)

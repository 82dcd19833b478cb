"""The report in a real browser: browser.py PROGRAM STUDY FOLDER

Debian's chromium opens report.html, headless, in the widths of a telephone, a tablet and a desk, light and dark, and
prints it to A4. It must not write to the console, ask the network for anything, or let content stand outside the window
or the sheet; links must lead somewhere and figures must say what they show.
"""
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys

MEASURE = """
<script>
addEventListener("load", () => {
  const wide = innerWidth, out = [];
  for (const e of document.body.querySelectorAll("*")) {
    const box = e.getBoundingClientRect();
    if (e.closest("svg") && e.tagName !== "svg") continue;
    if (box.width > 1 && box.right > wide + 1 && !e.closest("thead")) out.push(e.tagName + " " + e.textContent.slice(0, 40));
  }
  const dead = [...document.querySelectorAll("a[href^='#']")].filter(a => !document.getElementById(a.getAttribute("href").slice(1)));
  const mute = [...document.querySelectorAll("figure svg")].filter(s => s.getAttribute("role") !== "img" || !(s.getAttribute("aria-label") || s.querySelector("title")));
  const found = {wide, outside: out.slice(0, 5), dead: dead.map(a => a.href), mute: mute.length,
                 figures: document.querySelectorAll("figure svg").length,
                 asked: performance.getEntriesByType("resource").map(r => r.name),
                 scroll: document.documentElement.scrollWidth, ids: [...document.querySelectorAll("[id]")].map(e => e.id)};
  parent.postMessage(JSON.stringify(found), "*");
});
</script>
"""


# Chromium's own windows are at least 500 px wide; a frame in one may be narrower.
FRAME = """<!DOCTYPE html><title></title><iframe src="{}" style="width: {}px; height: 900px; border: 0"></iframe>
<script>addEventListener("message", e => document.title = "measured" + e.data)</script>"""


def chromium(folder, *options, page):
    """What it writes to stdout and stderr."""
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions",
         "--disable-background-networking", "--disable-dev-shm-usage", "--disable-component-update", "--enable-logging=stderr",
         f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=5000", *options, page.as_uri()],
        capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


def check_window(folder, page, width, dark):
    options = ["--dump-dom", "--window-size=1400,1000"] + (["--blink-settings=preferredColorScheme=0"] if dark else [])
    frame = page.with_name("frame.html")
    frame.write_text(FRAME.format(page.name, width))
    dom, said = chromium(folder, *options, page=frame)
    console = [line for line in said.splitlines() if "CONSOLE" in line]
    assert not console, console
    found = json.loads(html.unescape(re.search(r"<title>measured(.*?)</title>", dom, re.S).group(1)))
    assert found["wide"] == width, found["wide"]
    assert not found["outside"] and found["scroll"] <= found["wide"], (width, found["outside"], found["scroll"])
    assert not found["dead"], found["dead"]
    assert found["figures"] > 3 and found["mute"] == 0, found
    assert len(found["ids"]) == len(set(found["ids"])), "an id stands twice"
    assert not found["asked"], found["asked"]
    print(f"{width} px{', dark' if dark else ''}: {found['figures']} figures, nothing outside {found['wide']} px")


class Words(html.parser.HTMLParser):
    """The words of a page outside its figures and styles."""

    def __init__(self):
        super().__init__()
        self.inside, self.words = [], []

    def handle_starttag(self, tag, attrs):
        if tag in ("svg", "style", "script", "title"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and self.inside[-1] == tag:
            self.inside.pop()

    def handle_data(self, data):
        if not self.inside:
            self.words += re.findall(r"[A-Za-z]{4,}", data)


def check_print(folder, page):
    pdf, on_paper = folder / "report.pdf", folder / "on-paper.html"
    on_paper.write_text(page.read_text().replace("</head>", "<style>@page { size: A4; }</style></head>"))
    chromium(folder, f"--print-to-pdf={pdf}", "--no-pdf-header-footer", page=on_paper)
    boxes = subprocess.run(["pdftotext", "-bbox", str(pdf), "-"], capture_output=True, text=True, check=True).stdout
    sheets = re.findall(r'<page width="([\d.]+)" height="([\d.]+)"', boxes)
    assert sheets
    for width, height in sheets:
        assert abs(float(width) - 595) < 3 and abs(float(height) - 842) < 3, (width, height)
    beyond = [word for x, word in re.findall(r'xMax="([\d.]+)" yMax="[\d.]+">(.*?)</word>', boxes) if float(x) > 595 - 20]
    assert not beyond, beyond[:10]
    printed = re.findall(r"[A-Za-z]{4,}", re.sub(r"<.*?>", " ", boxes))
    reader = Words()
    reader.feed(page.read_text())
    missing = {word for word in set(reader.words) if printed.count(word) < 0.9 * reader.words.count(word)}
    assert len(missing) <= 0.02 * len(set(reader.words)), sorted(missing)[:20]  # a word may be hyphenated over two lines
    print(f"A4: {len(sheets)} sheets, {len(printed)} words, none outside")


def main(program, study, keep):
    folder = pathlib.Path(keep)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for command in ("calibrate", "plan"):
        done = subprocess.run([program, command, study, "--out", str(folder / "out"), "--quiet"])
        assert done.returncode in (0, 2), done.returncode
    page = folder / "out" / "report.html"
    check_print(folder, page)
    measured = folder / "measured.html"
    measured.write_text(page.read_text().replace("</body>", MEASURE + "</body>"))
    for width in (400, 768, 1280):
        check_window(folder, measured, width, dark=False)
    check_window(folder, measured, 1280, dark=True)


if __name__ == "__main__":
    main(*sys.argv[1:])

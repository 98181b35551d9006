#!/usr/bin/env python3
"""The page of a batch in a real browser, narrow and wide, light and dark: it loads nothing but its thumbnails, fits
the window, is readable, and its film plays."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from web_driver import Browser, missing_programs

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from requirements import skip

ROOT = Path(__file__).resolve().parents[2]
FRAMES = 5  # and one that fails


def luminance(colour):
    """Relative luminance of "rgb(r, g, b)", as WCAG 2 defines it."""
    channels = [int(value) / 255 for value in re.findall(r"\d+", colour)[:3]]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return sum(weight * c for weight, c in zip((0.2126, 0.7152, 0.0722), linear))


def contrast(one, other):
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


class BatchPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        folder = Path(temporary.name)
        for frame in range(1, FRAMES + 1):
            (folder / f"c.{frame:04}.vdb").symlink_to(ROOT / "data/cloud.vdb")
        scene = (ROOT / "data/cloud.toml").read_text(encoding="utf-8")
        (folder / "a <b> & c.toml").write_text(scene.replace("cloud.vdb", "c.####.vdb"), encoding="utf-8")
        done = subprocess.run(
            [os.environ["VDBEAM_BINARY"], "render", "a <b> & c.toml", f"--frames=1-{FRAMES + 1}", "-o", "o.####.exr",
             "--html", "page", "--passes", "3", "--resolution", "96x54", "--set", "render.photons=2000", "-q"],
            cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 3, done.stderr
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.url = (folder / "page/index.html").as_uri()

    def value(self, expression):
        return self.browser.run(f"return {expression}")

    def open(self, width, scheme):
        devtools = self.browser.devtools
        devtools("Emulation.setEmulatedMedia",
                 {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        devtools("Emulation.setDeviceMetricsOverride",
                 {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        self.browser.open(self.url)

    def test_is_readable_at_all_sizes_and_schemes(self):
        for width in (400, 1400):
            for scheme in ("light", "dark"):
                with self.subTest(width=width, scheme=scheme):
                    self.open(width, scheme)
                    self.assertTrue(self.value("document.documentElement.scrollWidth <= innerWidth"))
                    self.assertEqual(self.value("document.querySelectorAll('svg').length"), 3)
                    # Words of the charts are not smaller than 9 pixels.
                    self.assertGreater(self.value(
                        "document.querySelector('svg').getBoundingClientRect().width / 400 * 12"), 9)
                    back = self.value("getComputedStyle(document.body).backgroundColor")
                    self.assertEqual(luminance(back) > 0.5, scheme == "light")
                    for selector, property in (("h1", "color"), ("figcaption", "color"), (".failed", "color"),
                                               ("svg text", "fill"), (".tile span", "color")):
                        colour = self.value(f"getComputedStyle(document.querySelector('{selector}')).{property}")
                        self.assertGreater(contrast(colour, back), 4.5, selector)  # WCAG 2, level AA
                    self.assertEqual(self.browser.console_errors(), [])

    def test_loads_nothing_but_thumbnails(self):
        self.open(1400, "light")
        self.browser.run("document.querySelectorAll('img').forEach(image => image.loading = 'eager')")
        self.browser.run("return Promise.all([...document.images].map(image => image.decode()))")
        names = self.value("[...document.querySelectorAll('[src], [href]')].map(e => e.src || e.href)")
        self.assertEqual({re.sub(r".*/page/", "", name) for name in names},
                         {"data:,", *(f"frame.{frame:04}.png" for frame in range(1, FRAMES + 1))})
        self.assertEqual(self.value("[...document.images].filter(image => image.naturalWidth === 0).length"), 0)
        self.assertNotIn("url(", self.value("document.documentElement.outerHTML"))
        self.assertEqual(self.value("document.querySelectorAll('.strip figure').length"), FRAMES + 1)

    def test_the_film_plays_and_stops(self):
        self.open(1400, "light")
        place = "document.getElementById('place').textContent"
        self.assertEqual(self.value(place), "frame 1")
        self.browser.run(f"""window.seen = new Set();
            new MutationObserver(() => seen.add({place})).observe(document.getElementById("place"),
                                                                {{childList: true}});""")
        self.browser.click("#play")
        self.browser.run(f"""return new Promise(done => {{
            const wait = setInterval(() => seen.size == {FRAMES} && (clearInterval(wait), done()), 20); }})""")
        self.browser.click("#play")
        self.assertEqual(self.value("document.getElementById('play').textContent"), "Play")
        self.browser.click(".strip figure:nth-child(4) img")
        self.assertEqual(self.value(place), "frame 4")
        self.assertTrue(self.value("document.getElementById('film').src").endswith("frame.0004.png"))

    def test_points_show_their_values(self):
        self.open(400, "dark")
        titles = self.value("[...document.querySelectorAll('svg title')].map(title => title.textContent)")
        self.assertRegex(titles[0], r"^frame 1: MRSE [\d.e-]+ \(95 %: [\d.e-]+ to [\d.e-]+\)$")
        self.assertIn(f"frame {FRAMES + 1}: failed", titles)

    def test_texts_are_shown_as_they_are(self):
        self.open(1400, "light")
        self.assertEqual(self.value("document.querySelector('h1').textContent"), "a <b> & c.toml")
        self.assertEqual(self.value("document.querySelectorAll('b b, dd b').length"), 0)
        cells = self.value("[...document.querySelectorAll('tbody td')].map(cell => cell.textContent)")
        self.assertEqual(cells[:2], [str(FRAMES + 1), "2"])
        self.assertIn("a <b> & c.toml:", cells[2])


if __name__ == "__main__":
    if missing_programs():
        skip("browser", f"{' and '.join(missing_programs())} missing; install chromium and "
             "chromium-driver")
    unittest.main()

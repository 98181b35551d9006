#!/usr/bin/env python3
"""The page of tools/error_vs_time.py in a real browser: it loads without errors, the slider and the mouse
move the border between the images, the images can be chosen."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from fake_renderer import install
from web_driver import Browser, missing_programs

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from requirements import skip

ROOT = Path(__file__).resolve().parents[2]


class ErrorPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        folder = Path(temporary.name)
        for name in ("cloud", "smoke"):
            (folder / f"{name}.toml").write_text(f"# {name}\n", encoding="utf-8")
        subprocess.run([ROOT / "tools/error_vs_time.py", "--binary", install(folder), "--output",
                        folder / "out", "--seeds", "1-2", "--scenes", folder / "cloud.toml",
                        folder / "smoke.toml"], check=True, stdout=subprocess.DEVNULL)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.url = (folder / "out/index.html").as_uri()

    def setUp(self):
        self.browser.open(self.url)

    def value(self, expression):
        return self.browser.run(f"return {expression}")

    def border(self):
        """Where the images of the first scene meet, in percent, from what is shown."""
        return self.value("""(() => {
            const line = document.querySelector(".compare .line").getBoundingClientRect(),
                  box = document.querySelector(".compare").getBoundingClientRect();
            return 100 * ((line.left + line.right) / 2 - box.left) / box.width; })()""")

    def test_loads_everything_without_errors(self):
        self.assertEqual(self.value("document.querySelectorAll('section').length"), 2)
        self.assertEqual(self.value("[...document.images].filter(i => !i.complete || "
                                    "i.naturalWidth === 0).length"), 0)
        # Four estimators in each of two scenes.
        self.assertEqual(self.value("document.querySelectorAll('section figure').length"), 8)
        self.assertEqual(self.value("document.querySelectorAll('table tbody tr').length"), 8)
        # Nothing comes from elsewhere, and nothing hangs over the edge.
        self.assertEqual(self.value("performance.getEntriesByType('resource')"
                                    ".filter(r => !r.name.startsWith('data:')).length"), 0)
        self.assertTrue(self.value("document.documentElement.scrollWidth <= innerWidth"))
        self.assertEqual(self.browser.console_errors(), [])

    def hover(self, fraction):
        """Puts the pointer on the first plot, at this fraction of the width of its axes; returns the lines shown."""
        offset = self.value(f"""(() => {{
            const place = scenes[0].place,
                  box = document.querySelector(".plot").getBoundingClientRect();
            return box.width * (place.left + {fraction} * (place.right - place.left) - 0.5); }})()""")
        self.browser.drag(".plot", (0, 0), (round(offset), 0))
        return self.value("[...document.querySelectorAll('.values')[0].children].map(line => line.textContent)")

    def test_pointer_shows_the_values_of_all_curves(self):
        lines = self.hover(0.5)
        self.assertEqual(len(lines), 5)
        seconds = float(lines[0].split()[1])
        products = {"beam": 0.002, "gather": 0.001, "march": 0.05, "path": 0.03}
        for line in lines[1:]:
            # The error is C / seconds, with factors of 1 and 1.1 for the seeds 1 and 2.
            name, mean, low, high = re.match(r"(\w+): MRSE (\S+) \((\S+) to (\S+) over 2 seeds\)", line).groups()
            for text, factor in ((mean, 1.1 ** 0.5), (low, 1), (high, 1.1)):
                self.assertAlmostEqual(float(text) * seconds / products[name] / factor, 1, delta=0.03)
        self.assertEqual(self.value("document.querySelector('.pointer').hidden"), False)
        self.assertIn("beam: no value", self.hover(0.01))  # before the first pass has ended
        self.assertEqual(self.browser.console_errors(), [])

    def test_slider_moves_the_border(self):
        self.assertAlmostEqual(self.border(), 50, delta=1)
        slider = "section input[type=range]"
        width = self.value(f"document.querySelector('{slider}').getBoundingClientRect().width")
        self.browser.drag(slider, (0, 0), (int(width / 4), 0))
        moved = float(self.value(f"document.querySelector('{slider}').value"))
        self.assertGreater(moved, 60)
        self.assertAlmostEqual(self.border(), moved, delta=1)
        clip = self.value("getComputedStyle(document.querySelector('.compare .left')).clipPath")
        self.assertIn(f"{100 - moved:g}"[:4], clip)
        # The other scene keeps its own.
        self.assertEqual(self.value(f"document.querySelectorAll('{slider}')[1].value"), "50")
        self.assertEqual(self.browser.console_errors(), [])

    def test_mouse_on_the_images_moves_the_border(self):
        width = self.value("document.querySelector('.compare').getBoundingClientRect().width")
        self.browser.drag(".compare", (0, 0), (int(-0.3 * width), 0))
        self.assertAlmostEqual(self.border(), 20, delta=1)

    def test_pairs_of_images_change(self):
        def shown():
            return self.value("['.left', '.right'].map(s => "
                              "document.querySelector('.compare ' + s).src)")

        first = shown()
        self.assertNotEqual(first[0], first[1])
        captions = {self.value("document.querySelector('.caption').textContent")}
        seen = {first[0]}
        for estimator in (2, 3, 4):
            self.browser.click(f".choose-left option:nth-child({estimator})")
            left, right = shown()
            self.assertNotIn(left, seen)
            self.assertEqual(right, first[1])
            seen.add(left)
            captions.add(self.value("document.querySelector('.caption').textContent"))
        self.assertEqual(len(captions), 4)
        self.browser.click(".choose-right option:nth-child(1)")
        self.assertEqual(shown()[1], first[0])
        self.assertEqual(self.browser.console_errors(), [])


if __name__ == "__main__":
    if missing_programs():
        skip("browser", f"{' and '.join(missing_programs())} missing; install chromium and "
             "chromium-driver")
    unittest.main()

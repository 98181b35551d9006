"""The generated parts of docs/reference are what the program prints."""
import contextlib
import io
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_reference  # noqa: E402


class Reference(unittest.TestCase):
    def test_is_that_of_the_program(self):
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            status = make_reference.main(["--check"])
        self.assertEqual(status, 0, output.getvalue())

    def test_a_missing_table_stops(self):
        text = (ROOT / "docs" / "reference" / "scene.md").read_text(encoding="utf-8")
        with self.assertRaises(SystemExit):
            make_reference.scene_page(text.replace("<!-- keys: light -->", ""))

    def test_a_stale_table_is_replaced(self):
        page = make_reference.scene_page((ROOT / "docs" / "reference" / "scene.md").read_text(encoding="utf-8"))
        stale = page.replace("`extinction`", "`extnction`", 1)
        self.assertNotEqual(stale, page)
        self.assertEqual(make_reference.scene_page(stale), page)

    def test_every_command_has_its_options(self):
        page = make_reference.cli_page()
        for option in ("--skip-existing", "--splits", "--second", "--no-pilot", "--allow-gaps"):
            self.assertIn(option, page)


if __name__ == "__main__":
    unittest.main()

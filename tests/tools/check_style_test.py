"""The text of the tree keeps the rules of docs/developer/style.md, and the check of the rules can fail."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import check_style  # noqa: E402


def messages(path, text):
    return [message for _, message in check_style.check_text(pathlib.PurePosixPath(path), text)]


class Tree(unittest.TestCase):
    def test_has_no_violation(self):
        self.assertEqual(check_style.check_tree(ROOT), [])


class Checker(unittest.TestCase):
    def refuses(self, path, text, part):
        found = messages(path, text)
        self.assertTrue(any(part in message for message in found), (text, found))

    def accepts(self, path, text):
        self.assertEqual(messages(path, text), [])

    def test_words_in_pages(self):
        self.refuses("docs/a.md", "The pilot tells the noise.\n", "report")
        self.refuses("docs/a.md", "Likewise for fire.\n", "the same")
        self.refuses("docs/a.md", "One of so many passes.\n", "name the number")
        self.refuses("docs/a.md", "Two grids, of which one is read.\n", "split the sentence")
        self.refuses("docs/a.md", "The picture is sharp.\n", "image")
        self.accepts("docs/a.md", "The pilot measures the noise.\n")
        self.accepts("docs/a.md", "The key `picture` of the report.\n")
        self.accepts("docs/a.md", "    vdbeam tell --of which\n")  # code

    def test_words_in_comments(self):
        self.refuses("src/a.cpp", "int x; // tells the number\n", "report")
        self.refuses("tools/a.py", "x = 1  # as many as there are\n", "name the number")
        self.refuses("tools/a.sh", "# likewise\n", "the same")
        self.accepts("src/a.cpp", "int x; // the number of pictures\n")  # users do not read it

    def test_words_in_messages(self):
        self.refuses("src/a.cpp", 'fail("the picture is black");\n', "image")
        self.refuses("src/a.cpp", 'fail("the report tells more");\n', "report")
        self.accepts("src/a.cpp", 'report["picture"] = 1;\n')
        self.accepts("tests/a_test.cpp", 'find("it tells more");\n')  # input of a test

    def test_comments_begin_with_their_subject(self):
        self.refuses("src/a.h", "/// Of a leaf: its voxels.\nint x;\n", "subject")
        self.refuses("tools/a.py", '"""Of one renderer."""\n', "subject")
        self.accepts("src/a.h", "/// Voxels of a leaf.\nint x;\n")

    def test_lines_are_numbered(self):
        found = check_style.check_text(pathlib.PurePosixPath("docs/a.md"), "Fine.\n\nIt told us.\n")
        self.assertEqual([number for number, _ in found], [3])


if __name__ == "__main__":
    unittest.main()

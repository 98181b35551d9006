#!/usr/bin/env python3
"""What vdbeam writes to a terminal: a bar on one line at any width and after a resize, colours only
where they are wanted, and no escape sequence under TERM=dumb."""
import fcntl
import os
import pty
import re
import struct
import subprocess
import tempfile
import termios
import unittest

PROGRAM = os.environ["VDBEAM_BINARY"]
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CLOUD = os.path.join(SOURCE, "data", "cloud.toml")
ERASE = "\r\x1b[J"


def set_size(descriptor, columns):
    fcntl.ioctl(descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))


class Terminal(unittest.TestCase):
    def run_in_terminal(self, words, columns=80, on_output=None, **variables):
        """Text that the program wrote to a terminal; on_output(master, text so far) may change it."""
        master, slave = pty.openpty()
        set_size(slave, columns)
        settings = termios.tcgetattr(slave)
        settings[1] &= ~termios.OPOST  # line ends arrive as they were written
        termios.tcsetattr(slave, termios.TCSANOW, settings)
        environment = {"PATH": os.environ["PATH"], "TERM": "xterm-256color", **variables}
        with tempfile.TemporaryDirectory() as folder:
            child = subprocess.Popen([PROGRAM, *words], cwd=folder, env=environment,
                                     stdin=slave, stdout=slave, stderr=slave)
            os.close(slave)
            text = ""
            while True:
                try:
                    data = os.read(master, 4096)
                except OSError:  # Linux: the last writer is gone
                    break
                if not data:
                    break
                text += data.decode()
                if on_output:
                    on_output(master, text)
            child.wait()
            os.close(master)
        return text

    def render(self, **arguments):
        return self.run_in_terminal(
            ["render", CLOUD, "-o", "a.####.exr", "-f", "1-4", "--resolution", "16x9", "--passes", "6",
             "--set", "render.photons=1000"], **arguments)

    def bars(self, text):
        """The bars in the order in which they were drawn; each ends with the cursor at its start."""
        return re.findall(re.escape(ERASE) + r"([^\r\n\x1b]+)\r", text)

    def test_bar_fits_any_width(self):
        for columns in (120, 60, 40, 20, 8):
            text = self.render(columns=columns)
            bars = self.bars(text)
            self.assertTrue(bars, repr(text))
            for bar in bars:
                self.assertLess(len(bar), columns, bar)
                self.assertTrue(bar.startswith("frame "[:columns - 1]), bar)
            # Nothing else moves the cursor, and no bar is left behind when a frame ends.
            self.assertEqual(set(re.findall(r"\x1b[^a-zA-Z]*[a-zA-Z]", text)), {"\x1b[J"})
            for bar in bars:
                self.assertNotIn(bar + "\n", text)
        self.assertIn("[", self.bars(self.render(columns=120))[0])

    def test_bar_follows_a_resize(self):
        narrow = 30
        drawn_before = []

        def shrink(master, text):
            if not drawn_before and self.bars(text):
                drawn_before.append(len(self.bars(text)))
                set_size(master, narrow)

        text = self.render(columns=100, on_output=shrink)
        bars = self.bars(text)
        # One more may have been on its way while the size changed.
        after = bars[drawn_before[0] + 1:]
        self.assertTrue(after, repr(text))
        for bar in after:
            self.assertLess(len(bar), narrow, bar)

    def test_dumb_terminal_gets_plain_lines(self):
        for term in ("dumb", ""):
            text = self.render(TERM=term)
            self.assertNotIn("\x1b", text)
            self.assertNotIn("\r", text)
            self.assertIn("frame 2 (2/4): a.0002.exr: 6 passes", text)

    def test_errors_are_red_where_colours_are_wanted(self):
        words = ["render", "nothing.vdb"]
        self.assertRegex(self.run_in_terminal(words), "^\x1b\\[31m[^\x1b\n]*nothing.vdb[^\x1b\n]*\x1b\\[0m\n$")
        self.assertNotIn("\x1b", self.run_in_terminal(words, NO_COLOR="1"))
        self.assertNotIn("\x1b", self.run_in_terminal(words, TERM="dumb"))
        self.assertIn("\x1b[31m", self.run_in_terminal(words, NO_COLOR=""))
        piped = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
        self.assertNotIn("\x1b", piped.stderr)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""`--display`: a recorder of packets gets the image as tev would, after a lost connection too; a viewer that is not
there, or does not read, costs a render nothing."""
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import DATA, InTempFolder  # noqa: E402

VDBEAM = os.environ["VDBEAM_BINARY"]
FOG = str(DATA / "fog.vdb")
WIDTH, HEIGHT = 32, 18
SMALL = ["--threads", "1", "--set", "render.photons=2000", "-q"]
CREATE, UPDATE = 4, 6
PATIENCE = 120  # seconds, of a render that must not wait for its viewer


class Fields:
    """The fields of a packet."""

    def __init__(self, data):
        self.data, self.place = data, 0

    def take(self, form):
        found = struct.unpack_from("<" + form, self.data, self.place)
        self.place += struct.calcsize("<" + form)
        return found[0] if len(found) == 1 else found

    def text(self):
        end = self.data.index(b"\0", self.place)
        found = self.data[self.place:end].decode()
        self.place = end + 1
        return found


class Recorder:
    """A server that takes the packets of one connection after the other; `most`: packets of the first one."""

    def __init__(self, most=None):
        self.server = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self.server.getsockname()[1]}"
        self.most = most
        self.connections = []
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while True:
            try:
                connection, _ = self.server.accept()
            except OSError:
                return
            packets = []
            self.connections.append(packets)
            with connection:
                while self.most is None or len(self.connections) > 1 or len(packets) < self.most:
                    packet = self.packet(connection)
                    if packet is None:
                        break
                    packets.append(packet)

    @staticmethod
    def exactly(connection, size):
        data = b""
        while len(data) < size:
            piece = connection.recv(min(65536, size - len(data)))
            if not piece:
                return None
            data += piece
        return data

    def packet(self, connection):
        """(kind, rest) of the next packet, or None at the end."""
        head = self.exactly(connection, 4)
        rest = head and self.exactly(connection, struct.unpack("<I", head)[0] - 4)
        return rest and (rest[0], rest[1:])

    def close(self):
        """Waits until what was sent has been read."""
        time.sleep(0.3)
        self.server.close()


class ShownImages(InTempFolder):
    def render(self, address, *words, size=f"{WIDTH}x{HEIGHT}"):
        result = subprocess.run([VDBEAM, "render", FOG, "-o", "fog.exr", "--passes", "6", "--display", address,
                                 "--resolution", size, *SMALL, *words], cwd=self.folder.name, capture_output=True, text=True, check=False, timeout=PATIENCE)
        self.assertEqual(result.returncode, 0, result.stderr)

    def create(self, packet):
        """Channels of a CreateImage packet."""
        kind, data = packet
        self.assertEqual(kind, CREATE)
        fields = Fields(data)
        self.assertEqual((fields.take("B"), fields.text()), (0, "fog.exr"))
        self.assertEqual((fields.take("i"), fields.take("i")), (WIDTH, HEIGHT))
        channels = [fields.text() for _ in range(fields.take("i"))]
        self.assertEqual(fields.place, len(data))
        return channels

    def update(self, packet):
        """(channel, values) of an UpdateImage packet."""
        kind, data = packet
        self.assertEqual(kind, UPDATE)
        fields = Fields(data)
        self.assertEqual((fields.take("B"), fields.text(), fields.take("i")), (0, "fog.exr", 1))
        channel = fields.text()
        self.assertEqual(fields.take("4i"), (0, 0, WIDTH, HEIGHT))
        self.assertEqual(fields.take("2q"), (0, 1))
        values = fields.take(f"{WIDTH * HEIGHT}f")
        self.assertEqual(fields.place, len(data))
        return channel, values

    def test_every_image_is_sent_whole(self):
        recorder = Recorder()
        self.render(recorder.address, "--snapshot", "1")
        recorder.close()
        self.assertEqual(len(recorder.connections), 1)
        packets = recorder.connections[0]
        latest, created, images = {}, [], 0
        for packet in packets:
            if packet[0] == CREATE:
                created = self.create(packet)
                continue
            channel, values = self.update(packet)
            latest[channel] = values
            images += channel == created[-1]
        self.assertLessEqual({"R", "G", "B", "A", "volume.R", "depth.Z"}, set(created))
        self.assertEqual(set(created), set(latest))
        self.assertGreaterEqual(images, 2)
        # The last image is the finished one, pixel by pixel; the file has halves.
        for channel, values in self.file_channels("fog.exr").items():
            for shown, written in zip(latest[channel], values):
                self.assertLessEqual(abs(shown - written), 1e-6 + abs(written) / 1000, channel)

    def file_channels(self, name):
        """The values of each channel of an EXR, by oiiotool."""
        text = subprocess.run(["oiiotool", "--dumpdata", name], cwd=self.folder.name, capture_output=True, text=True,
                              check=True).stdout
        names = re.search(r"channel list: (.*)", subprocess.run(
            ["oiiotool", "--info", "-v", name], cwd=self.folder.name, capture_output=True, text=True,
            check=True).stdout)[1]
        names = [word.split()[0] for word in names.split(", ")]
        pixels = [[float(word) for word in line.split("):")[1].split()] for line in text.splitlines() if "Pixel (" in line]
        self.assertEqual(len(pixels), WIDTH * HEIGHT)
        return dict(zip(names, zip(*pixels)))

    def test_frames_have_names_of_their_own(self):
        recorder = Recorder()
        for frame in (1, 2):
            shutil.copy(FOG, self.file(f"fog.{frame:04}.vdb"))
        subprocess.run([VDBEAM, "render", "fog.####.vdb", "-o", "out.####.exr", "-f", "1-2", "--passes", "1", "--display",
                        recorder.address, "--resolution", f"{WIDTH}x{HEIGHT}", *SMALL], cwd=self.folder.name, check=True)
        recorder.close()
        created = []
        for kind, data in recorder.connections[0]:
            if kind == CREATE:
                fields = Fields(data)
                created.append((fields.take("B"), fields.text())[1])
        self.assertEqual(created, ["out.0001.exr", "out.0002.exr"])

    def test_live_image_of_another_size_is_created_anew(self):
        recorder = Recorder()
        scene = pathlib.Path(self.file("fog.toml"))
        text = f"[[volume]]\nfile = '{FOG}'\n[[light]]\ntype = 'environment'\n[render]\npasses = 1\n[image]\n"
        scene.write_text(text + "width = 32\nheight = 18\n")
        live = subprocess.Popen([VDBEAM, "live", "fog.toml", "--display", recorder.address, "--progress", "json", *SMALL],
                                cwd=self.folder.name, stdout=subprocess.PIPE, text=True)
        for size in ((32, 18), (20, 24)):
            scene.write_text(text + "width = {}\nheight = {}\n".format(*size))
            while json.loads(live.stdout.readline())["event"] != "finished":
                pass
        live.terminate()
        live.communicate(timeout=PATIENCE)
        recorder.close()
        sizes = {"now": None, "created": []}
        for kind, data in recorder.connections[0]:
            fields = Fields(data)
            self.assertEqual((fields.take("B"), fields.text()), (0, "fog.toml"))
            if kind == CREATE:
                sizes["now"] = fields.take("2i")
                sizes["created"].append(sizes["now"])
                continue
            self.assertEqual((fields.take("i"), fields.text() in "RGBA"), (1, True))
            self.assertEqual(fields.take("4i"), (0, 0, *sizes["now"]))
        self.assertEqual(sizes["created"], [(32, 18), (20, 24)])

    def test_lost_connection_is_made_again(self):
        recorder = Recorder(most=3)
        child = subprocess.Popen([VDBEAM, "render", FOG, "-o", "fog.exr", "--passes", "100000", "--display",
                                  recorder.address, "--resolution", f"{WIDTH}x{HEIGHT}", *SMALL], cwd=self.folder.name, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while time.monotonic() < end and (len(recorder.connections) < 2 or len(recorder.connections[1]) < 2):
            time.sleep(0.1)
        child.terminate()
        self.assertEqual(child.wait(timeout=60), 143)
        recorder.close()
        self.assertGreaterEqual(len(recorder.connections), 2)
        self.create(recorder.connections[1][0])  # a new viewer knows nothing of the image
        self.update(recorder.connections[1][1])

    def test_viewer_that_is_not_there_or_does_not_read(self):
        free = socket.create_server(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
        # Images as large as ever, of passes that take no time: what matters is how much is sent.
        words = ["--estimator", "path", "--set", "render.max_bounces=1", "--snapshot", "1"]
        self.render(address, *words, size="400x300")  # connections wait, nobody reads
        free.close()
        self.render(address, *words, "--no-resume", size="400x300")
        self.assertTrue(pathlib.Path(self.file("fog.exr")).exists())

    def test_a_viewer_that_is_not_there_is_reported_once(self):
        words = [VDBEAM, "render", FOG, "-o", "fog.exr", "--passes", "4", "--snapshot", "1", "--display", "127.0.0.1:9",
                 "--resolution", f"{WIDTH}x{HEIGHT}", *SMALL]
        for quiet, notes in ((False, 1), (True, 0)):
            result = subprocess.run([word for word in words if quiet or word != "-q"], cwd=self.folder.name,
                                    capture_output=True, text=True, check=True, timeout=PATIENCE)
            self.assertEqual(result.stderr.count("note: no viewer at 127.0.0.1:9 takes the image"), notes, result.stderr)

    def test_image_does_not_depend_on_it(self):
        self.render("127.0.0.1:9", "--no-resume")
        first = pathlib.Path(self.file("fog.exr")).rename(self.file("with.exr"))
        subprocess.run([VDBEAM, "render", FOG, "-o", "fog.exr", "--passes", "6", "--resolution",
                        f"{WIDTH}x{HEIGHT}", *SMALL], cwd=self.folder.name,
                       check=True)
        compare = subprocess.run([VDBEAM, "compare", first, "fog.exr"], cwd=self.folder.name, capture_output=True,
                                 text=True, check=True).stdout
        self.assertRegex(compare, r"RMSE\s+0\b")

    def test_bad_addresses(self):
        for address, text in (("localhost:x", "must look like HOST:PORT"), (":14158", "must look like HOST:PORT"), ("localhost", "must look like HOST:PORT"),
                              ("localhost:99999", "must look like HOST:PORT"),
                              ("no.such.host.invalid:1", "the host no.such.host.invalid is unknown")):
            result = subprocess.run([VDBEAM, "render", FOG, "--display", address, *SMALL], cwd=self.folder.name,
                                    capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 2)
            self.assertIn(text, result.stderr)


if __name__ == "__main__":
    unittest.main()

"""Damage to bytes and to text. Every function takes data and a random.Random, and returns data."""
import re
import struct

# What sizes, counts and offsets of headers are replaced by.
NUMBERS = [0, 1, 2, 255, 256, 0x7fff, 0x8000, 0xffff, 0x10000, 0xffffff, 0x7fffffff, 0x80000000, 0xffffffff,
           0x7fffffffffffffff, 0x8000000000000000, 0xffffffffffffffff]
FLOATS = [0.0, -0.0, 1e-45, 1e-38, 3.4e38, 1e30, -1.0, float("inf"), float("-inf"), float("nan")]
# Tokens that replace a word or number of a text.
WORDS = ["nan", "-nan", "inf", "-inf", "1e999", "-1", "0", "-0.0", "1e-320", "1e38", "1e308", "-1e308", "2147483647",
         "2147483648", "-2147483649", "4294967296", "9223372036854775807", "9223372036854775808", "1e-45", "0x10",
         "1_000", "true", "false", "''", '""', "[]", "{}", "[[]]", "null", "auto", "none", "1979-05-27", "#", "%", "\\",
         "/dev/null", "../..", "~", "-", "--", "\u00e9\u4e16", "a" * 300, "9" * 400, "[" * 3000, "x." * 3000 + "x"]
EXTREMES = ["0", "-1", "1", "0.5", "1e-320", "1e-45", "1e-9", "1e-3", "1e3", "1e6", "1e12", "1e20", "3.4e38", "1e38", "1e300",
            "-1e-9", "-1e38", "1.7976931348623157e308"]
MAGICS = [b"", b"\x89PNG\r\n\x1a\n", b"v/1\x01\x02\x00\x00\x00", b"#?RADIANCE\n", b"ply\n", b"glTF\x02\x00\x00\x00",
          b" BDV\x00\x00\x00\x00", b"\xff\xd8\xff\xe0", b"II*\x00", b"MM\x00*", b"\x1f\x8b", b"PK\x03\x04", b"\xef\xbb\xbf",
          b"\xff\xfe"]


def place(data, rng):
    """A place in the data, half of the time near its begin, where headers are."""
    return rng.randrange((min(len(data), 600) if rng.random() < 0.5 else len(data)) + 1)


def flip_bit(data, rng):
    return data if not data else poke(data, at := min(place(data, rng), len(data) - 1),
                                      bytes([data[at] ^ 1 << rng.randrange(8)]))


def poke(data, at, piece):
    return data[:at] + piece + data[at + len(piece):]


def truncate(data, rng):
    return data[:place(data, rng)]


def splice(data, rng):
    begin, end = sorted((place(data, rng), place(data, rng)))
    source = place(data, rng)
    return data[:begin] + data[source:source + rng.randrange(1, 200)] + data[end if end - begin < 400 else begin:]


def repeat(data, rng):
    at, length = place(data, rng), rng.choice([1, 2, 4, 16, 64, 400])
    return data[:at] + data[at:at + length] * rng.choice([2, 3, 10, 200]) + data[at + length:]


def cut_out(data, rng):
    at = place(data, rng)
    return data[:at] + data[at + rng.choice([1, 2, 4, 8, 100, 1000]):]


def number(data, rng):
    """A size, count or offset of another value, in either byte order and of any width."""
    width = rng.choice(["H", "I", "I", "Q"])
    value = rng.choice(NUMBERS) & (1 << 8 * struct.calcsize(width)) - 1
    return poke(data, place(data, rng), struct.pack(rng.choice("<>") + width, value))


def float_number(data, rng):
    return poke(data, place(data, rng), struct.pack("<f", rng.choice(FLOATS)))


def run_of_bytes(data, rng):
    byte = rng.choice([b"\0", b"\xff", b" ", b"\n", b"\x7f"])
    return poke(data, place(data, rng), byte * rng.choice([2, 4, 16, 100, 1000]))


def other_magic(data, rng):
    magic = rng.choice(MAGICS)
    return magic + data[len(magic):] if rng.random() < 0.7 else magic


def end_of_other(data, rng):
    """Two halves whose seam is somewhere else in each."""
    return data[:place(data, rng)] + data[place(data, rng):]


BYTES = [flip_bit, flip_bit, flip_bit, number, number, float_number, truncate, splice, repeat, cut_out, run_of_bytes,
         other_magic, end_of_other]


def bytes_of(data, rng):
    for _ in range(rng.choice([1, 1, 1, 2, 3, 8])):
        data = rng.choice(BYTES)(data, rng)
    return data


TOKEN = re.compile(rb'"[^"\n]*"|[-+]?\d[\w.+-]*|\w+|[^\s\w]')


def text_of(data, rng):
    """Other words, numbers and signs in a text; a line away, twice, or elsewhere."""
    for _ in range(rng.choice([1, 1, 2, 4])):
        lines, kind = data.split(b"\n"), rng.randrange(10)
        tokens = list(TOKEN.finditer(data))
        if kind < 6 and tokens:
            token = rng.choice(tokens)
            new = rng.choice(WORDS).encode() if rng.random() < 0.7 else rng.choice(tokens).group()
            if token.group().startswith(b'"') and rng.random() < 0.5:
                new = b'"' + new.strip(b'"') + b'"'
            data = data[:token.start()] + new + data[token.end():]
        elif kind == 6:
            data = b"\n".join(lines[:(at := rng.randrange(len(lines)))] + lines[at + 1:])
        elif kind == 7:
            data = b"\n".join(lines + [rng.choice(lines)] * rng.choice([1, 2, 100]))
        elif kind == 8:
            rng.shuffle(lines)
            data = b"\n".join(lines)
        else:
            data = bytes_of(data, rng)
    return data

"""Runs the program in a folder of its own and looks at what it leaves. The binary is the first argument."""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM = os.path.abspath(sys.argv[1])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
TINY = ["--size", "24x16"]


class Result:
    def __init__(self, process):
        self.code = process.returncode
        self.out = process.stdout.decode()
        self.err = process.stderr.decode()

    @property
    def json(self):
        return json.loads(self.out)


class CommandTest(unittest.TestCase):
    """Each test has an empty current folder, self.folder."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def run_program(self, *arguments, timeout=300, **environment):
        env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        env.update(environment)
        return Result(subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=env, capture_output=True,
                                     timeout=timeout))

    def good(self, *arguments, **environment):
        result = self.run_program(*arguments, **environment)
        self.assertEqual(result.code, 0, result.err)
        return result

    def refused(self, code, parts, *arguments, **environment):
        """One clear line on standard error, nothing on standard output."""
        result = self.run_program(*arguments, **environment)
        self.assertEqual(result.code, code, f"{arguments}: {result.err or result.out}")
        self.assertEqual(result.out, "")
        lines = result.err.strip().splitlines()
        self.assertEqual(len(lines), 1, result.err)
        self.assertTrue(lines[0].startswith("lumiscope: "), lines[0])
        for part in parts:
            self.assertIn(part, lines[0])
        return lines[0]

    def bytes(self, name):
        return (self.folder / name).read_bytes()

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())


def png_text(data, keyword):
    """The value of a tEXt, zTXt or iTXt chunk."""
    position = 8
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        position += 12 + length
        key, _, rest = body.partition(b"\0")
        if key.decode("latin-1") != keyword:
            continue
        if kind == b"tEXt":
            return rest.decode("latin-1")
        if kind == b"zTXt":
            return zlib.decompress(rest[1:]).decode("latin-1")
        if kind == b"iTXt":
            compressed = rest[0]
            text = rest[2:].split(b"\0", 2)[2]
            return (zlib.decompress(text) if compressed else text).decode()
    return None


def write_png(path, width, height, colour):
    """An 8-bit RGB file; colour(x, y) gives the three values."""
    rows = b"".join(b"\0" + bytes(value for x in range(width) for value in colour(x, y)) for y in range(height))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) +
                     chunk(b"IEND", b""))


def read_png(data):
    """Rows of (r, g, b) of an 8-bit RGB or RGBA file without interlacing."""
    position, packed = 8, b""
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        position += 12 + length
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and colour in (2, 6)
        if kind == b"IDAT":
            packed += body
    step = 3 if colour == 2 else 4
    raw, stride, rows = zlib.decompress(packed), width * step + 1, []
    above = bytearray(width * step)
    for y in range(height):
        kind, line = raw[y * stride], bytearray(raw[y * stride + 1:(y + 1) * stride])
        for i in range(len(line)):
            a = line[i - step] if i >= step else 0
            b, c = above[i], above[i - step] if i >= step else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, len(line), step)])
        above = line
    return rows


def write_exr(path, width, height, colour):
    """Three float channels without compression; colour(x, y) gives the three values, which may be NaN or infinite."""
    def attribute(name, kind, body):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(body)) + body

    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", channels) +
              attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window) +
              attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0") +
              attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) +
              attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)) +
              attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    lines = []
    for y in range(height):
        row = [colour(x, y) for x in range(width)]
        lines.append(struct.pack("<ii", y, 12 * width) +
                     b"".join(struct.pack(f"<{width}f", *(values[c] for values in row)) for c in (2, 1, 0)))
    first = len(header) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * len(lines[0])) for y in range(height))
    path.write_bytes(header + offsets + b"".join(lines))


def exr_header(data):
    """Attributes of a single-part OpenEXR file, by name; channels as {name: type}."""
    position = 8
    attributes = {}
    while data[position] != 0:
        name, position = read_string(data, position)
        kind, position = read_string(data, position)
        size = struct.unpack("<i", data[position:position + 4])[0]
        attributes[name] = data[position + 4:position + 4 + size]
        position += 4 + size
    channels, position, table = {}, 0, attributes["channels"]
    while table[position] != 0:
        name, position = read_string(table, position)
        channels[name] = ("uint", "half", "float")[struct.unpack("<i", table[position:position + 4])[0]]
        position += 16
    attributes["channels"] = channels
    return attributes


def read_string(data, position):
    end = data.index(b"\0", position)
    return data[position:end].decode(), end + 1


def main():
    del sys.argv[1]
    unittest.main(verbosity=1)

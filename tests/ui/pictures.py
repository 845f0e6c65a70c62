"""Reading PNG files and comparing what they show, with nothing but the standard library."""
import json
import struct
import zlib


class Picture:
    def __init__(self, path):
        data = open(path, "rb").read()
        assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG"
        self.texts, packed, at = {}, b"", 8
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at : at + 8])
            body = data[at + 8 : at + 8 + length]
            if kind == b"IHDR":
                self.width, self.height, depth, colour = struct.unpack(">IIBB", body[:10])
                assert depth == 8 and colour in (2, 6), f"{path}: only RGB and RGBA of 8 bits are read"
                self.channels = 3 if colour == 2 else 4
            elif kind == b"IDAT":
                packed += body
            elif kind in (b"tEXt", b"zTXt", b"iTXt"):
                key = body.split(b"\0", 1)[0].decode("latin-1")
                self.texts[key] = len(body)
            at += 12 + length
        self.rows = self._unfilter(zlib.decompress(packed))

    def _unfilter(self, raw):
        stride, step = self.width * self.channels, self.channels
        rows, above = [], bytearray(stride)
        for y in range(self.height):
            start = y * (stride + 1)
            mode, row = raw[start], bytearray(raw[start + 1 : start + 1 + stride])
            for x in range(stride if mode else 0):
                left = row[x - step] if x >= step else 0
                up, corner = above[x], above[x - step] if x >= step else 0
                if mode == 1:
                    row[x] = (row[x] + left) & 255
                elif mode == 2:
                    row[x] = (row[x] + up) & 255
                elif mode == 3:
                    row[x] = (row[x] + (left + up) // 2) & 255
                elif mode == 4:
                    guess = left + up - corner
                    near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                    row[x] = (row[x] + near[2]) & 255
            rows.append(row)
            above = row
        return rows

    def pixel(self, x, y):
        at = x * self.channels
        return tuple(self.rows[y][at : at + 3])

    def mean(self, box, step=3):
        """Mean brightness of (x0, y0, x1, y1), 0 to 255."""
        x0, y0, x1, y1 = box
        values = [sum(self.pixel(x, y)) / 3 for y in range(y0, y1, step) for x in range(x0, x1, step)]
        return sum(values) / len(values)


def difference(a, b, box, step=3):
    """Mean absolute difference of two pictures in a box, 0 to 255."""
    x0, y0, x1, y1 = box
    total = count = 0
    for y in range(y0, y1, step):
        for x in range(x0, x1, step):
            total += sum(abs(p - q) for p, q in zip(a.pixel(x, y), b.pixel(x, y))) / 3
            count += 1
    return total / count


def truncated_glb(path):
    """A binary glTF that promises a triangle and ends in the middle of its JSON."""
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                       "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})
    body = text.encode() + b" " * (-len(text) % 4)
    whole = struct.pack("<4sIIII", b"glTF", 2, 20 + len(body), len(body), 0x4E4F534A) + body
    path.write_bytes(whole[:len(whole) // 2])

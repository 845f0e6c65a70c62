"""Nothing is declared in vain: every parameter of the tracer, the camera and the sky changes the image."""
import json

from lumiscope import CommandTest, main

SCENE = {
    "version": 1,
    "assets": {"ball": {"sphere": {"radius": 0.5, "segments": 16}}, "floor": {"rectangle": {"size": [6, 6]}}},
    "materials": {"chalk": {"base-color": 0.8, "roughness": 1}, "brushed": {"metallic": 1, "roughness": 0.9},
                  "glass": {"transmission": 1, "roughness": 0.05, "thickness": 1}},
    "instances": [{"asset": "floor", "material": "chalk"},
                  {"asset": "ball", "material": "glass", "translate": [-0.6, 0.5, 0]},
                  {"asset": "ball", "material": "brushed",
                   "keys": [{"time": 0, "translate": [0.6, 0.5, 0]}, {"time": 1, "translate": [1.6, 0.5, 0]}]}],
    "lights": {"near": {"sphere": {"radius": 0.1}, "radiance": 60, "translate": [-1.4, 1, 0.5]},
               "far": {"rectangle": {"size": [1, 1]}, "radiance": 20, "translate": [2, 3, 0], "look-at": [0, 0, 0]}},
    "environment": {"constant": [0.5, 0.6, 0.8]},
    "cameras": {"main": {"eye": [0, 1.2, 3], "look-at": [0, 0.4, 0], "focus": 3}, "side": {"eye": [3, 1, 1], "look-at": [0, 0, 0]}},
}
LENS = ["camera.aperture=0.2"]
BLADES = [*LENS, "camera.aperture-shape=bladed"]
# id: (another value, what has to be set for it to matter)
OTHERS = {
    "path.max-depth": ("1", []), "path.max-diffuse-depth": ("0", []), "path.max-specular-depth": ("0", []),
    "path.strategy": ("bsdf", []), "path.light-sampling": ("power", []), "path.roulette": ("false", []),
    "path.roulette-depth": ("0", []), "path.clamp": ("true", ["path.clamp-radiance=0.5"]),
    "path.clamp-radiance": ("0.2", ["path.clamp=true"]), "path.multiple-scattering": ("false", []),
    "path.regularize": ("true", []), "path.regularize-roughness": ("0.9", ["path.regularize=true"]),
    "path.regularize-decay": ("0.5", ["path.regularize=true"]), "path.regularize-after": ("any", ["path.regularize=true"]),
    "sampler.kind": ("halton", []), "sampler.halton-loop": ("1", ["sampler.kind=halton"]),
    "camera.select": ("side", []), "camera.jitter": ("none", []), "camera.eye": ("0,2,3", []),
    "camera.look-at": ("0,0,0", []), "camera.up": ("1,1,0", []), "camera.projection": ("orthographic", []),
    "camera.fov-y-deg": ("20", []), "camera.y-mag": ("3", ["camera.projection=orthographic"]), "camera.aperture": ("0.3", []),
    "camera.focus": ("1", LENS), "camera.aperture-shape": ("bladed", LENS), "camera.aperture-blades": ("3", BLADES),
    "camera.aperture-rotation-deg": ("20", BLADES), "camera.shutter": ("30", []), "camera.stereo": ("left", []),
    "camera.interaxial": ("0.5", ["camera.stereo=left"]),
    "environment.scale": ("3", []), "environment.rotate-deg": ("90", ["environment.file=sky.hdr"]), "environment.constant": ("1,0,0", []),
    "environment.file": ("sky.hdr", []),
    "render.spp": ("5", []), "render.seed": ("7", []), "render.fps": ("7", []),
}
# The size of the image needs no proof.
OBVIOUS = {"render.width", "render.height"}


class Parameters(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / "s.json").write_text(json.dumps(SCENE))
        header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
        (self.folder / "sky.hdr").write_bytes(header + bytes([128, 64, 32, 129, 20, 80, 160, 129]))
        self.count = 0

    def image(self, settings):
        self.count += 1
        name = f"{self.count}.exr"
        self.good("render", "s.json", "--module", "none", "--size", "32x24", "--spp", 4, "--frames", "2..3", "--warm-up", 1,
                  "--out", name, "--quiet", *(part for setting in settings for part in ("--set", setting)))
        return name

    def difference(self, a, b):
        return self.good("compare", a, b, "--metrics", "mae", "--json").json["metrics"]["mae"]

    def test_every_parameter_changes_the_image(self):
        groups = ("path.", "sampler.", "camera.", "environment.", "render.")
        declared = {p["id"] for p in self.good("list", "parameters", "--json").json if p["id"].startswith(groups)}
        self.assertEqual(declared - OBVIOUS, set(OTHERS), "each parameter has its row here")
        plain = {}
        for name, (value, condition) in OTHERS.items():
            key = tuple(condition)
            if key not in plain:
                plain[key] = self.image(condition)
            changed = self.image([*condition, f"{name}={value}"])
            self.assertGreater(self.difference(changed, plain[key]), 0, f"{name}={value} changes nothing")
        self.assertEqual(self.difference(self.image([]), plain[()]), 0, "the same settings, the same image")


if __name__ == "__main__":
    main()

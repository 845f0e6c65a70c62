"""Opens a study's report in a real browser: are tables, plots and images there, and does the wipe work?

    report_test.py LUMISCOPE FOLDER
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

from browser import Browser, find_browser
from pictures import Picture, difference

PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
STUDY = {
    "version": 1, "title": "A report to look at", "description": "Every part of a report in one small study.",
    "scenes": ["cornell"], "size": [240, 135], "spp": [1, 2, 4], "seeds": [1, 2], "reference": {"spp": 128},
    "frames": {"range": [0, 3], "measure": "all", "still": True}, "metrics": ["mse", "flip", "temporal"],
    "entries": [{"name": "raw", "module": "none"}, {"name": "mean", "module": "accumulate"},
                {"name": "limited", "module": "accumulate", "set": {"limit": True}}],
    "sweep": {"axes": {"max-samples": [1, 2], "path.roulette-depth": [2, 4]}, "entries": ["limited"]},
    "pairs": [{"entry": "mean", "against": "raw"}],
    "ablations": [{"entry": "mean", "stages": [{"name": "all but one", "set": {"limit": True, "max-samples": 1}}]}],
    "checks": [{"title": "The mean is better", "entry": "mean", "metric": "mse", "against": ["raw"], "at-most": 1}],
    "figures": [{"name": "strip", "entries": ["raw", "mean"], "crops": [{"name": "box", "box": [0.3, 0.4, 0.25, 0.3]},
                                                                          {"box": [0.6, 0.1, 0.2, 0.2]}]}],
}


def make_report():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    (FOLDER / "look.json").write_text(json.dumps(STUDY))
    run = subprocess.run([PROGRAM, "study", "look.json", "--out", "out", "--quiet"], cwd=FOLDER, capture_output=True, text=True,
                         timeout=400, env={**os.environ, "XDG_CACHE_HOME": str(FOLDER / "cache")})
    assert run.returncode == 0, run.stderr
    return FOLDER / "out" / "report.html"


def test_everything_is_there(browser):
    count = lambda selector: browser.value(f"document.querySelectorAll({json.dumps(selector)}).length")
    for section in ("checks", "tables", "convergence", "sweep", "frames", "figures", "pictures", "bias", "ablations", "times", "latex", "method"):
        assert count(f"h2#{section}") == 1, f"no section {section}"
    assert count("#tables ~ .card table, section table") >= 4
    assert count(".verdict") == 3 and count(".verdict.fails") == 0
    # Two metrics of images: two convergence plots with three points of each entry. A heat map for each metric and sample count.
    assert browser.value("document.querySelector('#convergence').parentElement.querySelectorAll('svg').length") == 2
    assert browser.value("[...document.querySelector('#convergence').parentElement.querySelectorAll('svg')].every(s => s.querySelectorAll('circle').length >= 18)")
    assert browser.value("document.querySelector('#sweep').parentElement.querySelectorAll('svg rect').length") == 3 * 3 * 4
    # Two entries, four points of the sweep, one without a stage, and the reference.
    assert count(".viewer") == 2 and count(".viewer .tile") == 2 * 8
    # An inset strip: two methods and the reference, two crops, maps, the bar.
    assert count(".strip svg image") == 1 + 2 * 2 * 2 + 2 + 1 and count(".strip svg text") > 12
    assert browser.value("[...document.querySelectorAll('.strip svg text')].some(t => t.textContent === 'Reference')")
    # Without its stage the mean of one frame is no mean: surely worse at the last frame, in bold.
    assert count("#ablations ~ .card td .sure") >= 1
    assert count("details.latex") == 5 and browser.value("document.querySelector('details.latex pre').textContent.includes('\\\\toprule')")
    assert browser.value("[...document.images].every(i => i.complete && i.naturalWidth === 240)"), "an image does not show"
    assert browser.value("performance.getEntriesByType('resource').filter(e => !e.name.startsWith('data:')).length") == 0, "it loads something"
    assert browser.value("!document.querySelector('main').innerText.match(/NaN|undefined|\\[object/)"), "a value is missing"
    assert browser.value("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the window"
    assert not browser.exceptions, browser.exceptions


def stage_of(browser):
    browser.value("document.querySelector('.stage').scrollIntoView({block: 'center', behavior: 'instant'})")
    x, y, width, height = browser.box(".stage")
    left, top = browser.value("[scrollX, scrollY]")
    return (x, y, width, height), (x - left, y - top)


def test_the_wipe(browser):
    browser.value("(() => { const v = document.querySelector('.viewer'); for (const [s, n] of [['.left-select', 'raw'], ['.right-select', 'Reference']])"
                  "{ const e = v.querySelector(s); e.value = n; e.dispatchEvent(new Event('change')); } })()")
    box, (x, y) = stage_of(browser)
    _, _, width, height = box
    shot = lambda name: Picture(browser.shot(FOLDER / f"{name}.png", box))
    middle = shot("wipe-middle")
    browser.drag(x + width / 2, y + height / 3, x + width * 0.8, y + height / 3)
    right = shot("wipe-right")
    browser.drag(x + width * 0.8, y + height / 3, x + width * 0.2, y + height / 3)
    left = shot("wipe-left")
    part = lambda a, b: (int(width * a), int(height * 0.3), int(width * b), int(height * 0.9))
    # Between the old and the new place of the line the other picture shows; beyond it nothing changes.
    assert difference(middle, right, part(0.53, 0.77)) > 5, "dragging the line right uncovers the left picture"
    assert difference(middle, right, part(0.05, 0.45)) == 0 and difference(middle, right, part(0.83, 0.98)) == 0
    assert difference(middle, left, part(0.23, 0.47)) > 5, "dragging the line left uncovers the right picture"
    assert difference(middle, left, part(0.05, 0.17)) == 0 and difference(middle, left, part(0.55, 0.98)) == 0
    # The left of the line is noisy, the right is not: the raw frame at one sample against the reference.
    roughness = lambda picture, box: difference(picture, Shifted(picture), box, 2)
    assert roughness(right, part(0.1, 0.7)) > 2 * roughness(left, part(0.3, 0.9))


class Shifted:
    """The same picture, five pixels further: over a pixel of the small image that is enlarged."""

    def __init__(self, picture):
        self.picture = picture

    def pixel(self, x, y):
        return self.picture.pixel(max(x - 5, 0), y)


def test_flip_and_maps(browser):
    box, (x, y) = stage_of(browser)
    _, _, width, height = box
    part = lambda a, b: (int(width * a), int(height * 0.2), int(width * b), int(height * 0.9))
    shot = lambda name: Picture(browser.shot(FOLDER / f"{name}.png", box))
    wipe = shot("wipe-again")  # its line stands at a fifth
    browser.click('[data-mode="flip"]')
    first = shot("flip-left")
    browser.click('[data-mode="flip"]')
    second = shot("flip-right")
    assert difference(first, second, part(0.1, 0.9)) > 5, "a flip shows the other picture"
    assert difference(first, wipe, part(0.02, 0.17)) == 0, "first the one that stands left of the wipe's line"
    assert difference(second, wipe, part(0.23, 0.97)) == 0, "then the one that stands right of it"
    browser.value("document.querySelector('.stage').focus()")
    browser.key(" ")
    assert difference(first, shot("flip-key"), part(0.02, 0.98)) == 0, "Space flips back"
    browser.key(" ")
    browser.click(".errors")
    assert difference(second, shot("error-map"), part(0.1, 0.9)) == 0, "the reference has no error map"
    browser.click('[data-mode="wipe"]')
    browser.drag(x + width * 0.2, y + height / 3, x + width * 0.7, y + height / 3)
    assert difference(first, shot("error-wipe"), part(0.25, 0.65)) > 5, "the left picture's error map shows"
    browser.click(".errors")


class Zoomed:
    """What a picture shows once it is enlarged about a point."""

    def __init__(self, picture, factor, x, y):
        self.picture, self.factor, self.x, self.y = picture, factor, x, y

    def pixel(self, x, y):
        return self.picture.pixel(round(self.x + (x - self.x) / self.factor), round(self.y + (y - self.y) / self.factor))


def test_zoom_is_of_all_pictures(browser):
    """Both viewers show their references; the wheel over the first enlarges both, about the same place."""
    browser.value("document.querySelectorAll('.viewer').forEach(v => { for (const s of ['.left-select', '.right-select'])"
                  "{ const e = v.querySelector(s); e.value = 'Reference'; e.dispatchEvent(new Event('change')); } })")
    browser.value("document.querySelectorAll('.stage').forEach((s, i) => { s.id = `stage${i}`; })")
    box, (x, y) = stage_of(browser)
    _, _, width, height = box
    both = lambda name: [Picture(browser.shot(FOLDER / f"{name}-{i}.png", browser.box(f"#stage{i}"))) for i in range(2)]
    before = both("zoom-before")
    browser.value("document.querySelector('.stage').focus()")
    browser.mouse("mouseWheel", x + width * 0.6, y + height * 0.4, deltaX=0, deltaY=-480)  # twice two octaves of 240
    after = both("zoom-after")
    inner = (int(width * 0.1), int(height * 0.2), int(width * 0.6), int(height * 0.9))
    for was, now in zip(before, after):
        expected = Zoomed(was, 4, width * 0.6, height * 0.4)
        right, wrong = difference(now, expected, inner), difference(now, was, inner)
        assert right < 0.2 * wrong, f"enlarged four times about the pointer: {right:.1f}, as it was: {wrong:.1f}"
    browser.drag(x + width * 0.5, y + height * 0.5, x + width * 0.4, y + height * 0.5)
    moved = both("zoom-moved")
    shift = int(width * 0.1)
    for was, now in zip(after, moved):
        panned = sum(sum(abs(p - q) for p, q in zip(now.pixel(u, v), was.pixel(u + shift, v))) for u in range(100, 600, 7) for v in range(150, 400, 7))
        still = sum(sum(abs(p - q) for p, q in zip(now.pixel(u, v), was.pixel(u, v))) for u in range(100, 600, 7) for v in range(150, 400, 7))
        assert panned < 0.2 * still, f"dragging pans both: {panned} against {still}"
    browser.click(".reset")
    assert difference(both("zoom-reset")[1], before[1], inner) == 0, "Fit shows all again"


def test_a_crop_is_marked_for_the_study_file(browser):
    _, (x, y) = stage_of(browser)
    _, _, width, height = browser.box(".stage")
    browser.drag(x + width * 0.25, y + height * 0.5, x + width * 0.5, y + height * 0.75, modifiers=8)  # Shift
    crop = json.loads(browser.value("document.querySelector('.crop .box').textContent"))
    assert crop["scene"] == "cornell" and crop["frame"] == 2
    assert all(abs(a - b) < 0.01 for a, b in zip(crop["crops"][0]["box"], (0.25, 0.5, 0.25, 0.25))), crop
    assert browser.value("getComputedStyle(document.querySelector('.mark')).display") == "block"


def test_the_page_fits_a_narrow_window(browser):
    for theme in ("light", "dark"):
        if browser.value("document.documentElement.dataset.theme") != theme:
            browser.click(".theme")
        browser.resize(400, 850)
        assert browser.value("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than a telephone"
        browser.shot(FOLDER / f"narrow-{theme}.png")
        browser.resize(1200, 900)


def test_figures_as_files(browser):
    """A strip as SVG, as a browser draws it, is the strip as PNG."""
    import xml.etree.ElementTree as xml
    folder = FOLDER / "out" / "figures"
    tree = xml.parse(folder / "strip.svg").getroot()
    assert tree.tag == "{http://www.w3.org/2000/svg}svg"
    for image in tree.iter("{http://www.w3.org/2000/svg}image"):
        assert image.get("href").startswith("data:image/png;base64,"), "it needs a file"
    width, height = float(tree.get("width")), float(tree.get("height"))
    png = Picture(folder / "strip.png")
    assert (png.width, png.height) == (round(2 * width), round(2 * height))
    browser.resize(int(width) + 20, int(height) + 20)
    browser.open(folder / "strip.svg")
    drawn = Picture(browser.shot(FOLDER / "strip-drawn.png", (0, 0, int(width), int(height))))
    browser.resize(1200, 900)
    total = count = worst = 0
    for v in range(2, int(height) - 2, 4):
        for u in range(2, int(width) - 2, 4):
            mine = [sum(png.pixel(2 * u + i, 2 * v + j)[c] for i in (0, 1) for j in (0, 1)) / 4 for c in range(3)]
            apart = sum(abs(a - b) for a, b in zip(mine, drawn.pixel(u, v))) / 3
            total, count, worst = total + apart, count + 1, max(worst, apart)
    assert total / count < 6, f"SVG and PNG differ by {total / count:.2f} of 255 on average"
    colours = {drawn.pixel(u, v) for v in range(0, int(height), 2) for u in range(0, int(width), 2)}
    assert len(colours) > 1000 and (230, 159, 0) in colours and (0, 158, 115) in colours, "pictures, and both crops' frames"


def test_screenshots(browser):
    pages = {}
    for theme in ("light", "dark"):
        if browser.value("document.documentElement.dataset.theme") != theme:
            browser.click(".theme")
        pages[theme] = Picture(browser.shot(FOLDER / f"report-{theme}.png", (0, 0, 1200, 900)))
    whole = (0, 0, 1200, 900)
    assert pages["light"].mean(whole) > 215, "a light page is mostly paper"
    assert pages["dark"].mean(whole) < 60, "a dark page is mostly dark"
    colours = {pages["light"].pixel(x, y) for x in range(0, 1200, 3) for y in range(0, 900, 3)}
    assert len(colours) > 50, "text and swatches are drawn"
    browser.shot(FOLDER / "report.png")
    # On paper: no controls, and nothing is cut off.
    browser.call("Emulation.setEmulatedMedia", media="print")
    assert browser.value("getComputedStyle(document.querySelector('.stage')).display") == "none"
    assert browser.value("[...document.querySelectorAll('.tile')].every(t => getComputedStyle(t).display !== 'none')")
    browser.call("Emulation.setEmulatedMedia", media="")


def main():
    if not find_browser():
        print("skipped: chromium is not installed")
        sys.exit(77)
    report = make_report()
    browser = Browser()
    try:
        browser.open(report, ready="document.documentElement.dataset.ready === 'yes' && [...document.images].every(i => i.complete)")
        for test in (test_everything_is_there, test_the_wipe, test_flip_and_maps, test_zoom_is_of_all_pictures,
                     test_a_crop_is_marked_for_the_study_file,
                     test_the_page_fits_a_narrow_window, test_screenshots, test_figures_as_files):
            test(browser)
            print(f"{test.__name__}: good")
    finally:
        browser.close()


if __name__ == "__main__":
    main()

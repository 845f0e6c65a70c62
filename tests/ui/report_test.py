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
    for section in ("tables", "convergence", "sweep", "frames", "pictures", "bias", "times", "method"):
        assert count(f"h2#{section}") == 1, f"no section {section}"
    assert count("#tables ~ .card table, section table") >= 4
    # Two metrics of images: two convergence plots with three points of each entry. A heat map for each metric and sample count.
    assert browser.value("document.querySelectorAll('section')[1].querySelectorAll('svg').length") == 2
    assert browser.value("[...document.querySelectorAll('section')[1].querySelectorAll('svg')].every(s => s.querySelectorAll('circle').length >= 18)")
    assert browser.value("document.querySelectorAll('section')[2].querySelectorAll('svg rect').length") == 3 * 3 * 4
    assert count(".viewer") == 2 and count(".viewer .tile") == 2 * 7
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


def test_flip_maps_and_zoom(browser):
    box, (x, y) = stage_of(browser)
    _, _, width, height = box
    inner = (int(width * 0.1), int(height * 0.2), int(width * 0.9), int(height * 0.9))
    shot = lambda name: Picture(browser.shot(FOLDER / f"{name}.png", box))
    browser.click('[data-mode="flip"]')
    first = shot("flip-left")
    browser.click('[data-mode="flip"]')
    second = shot("flip-right")
    assert difference(first, second, inner) > 5, "a flip shows the other picture"
    browser.click(".errors")
    assert difference(second, shot("error-map"), inner) == 0, "the reference has no error map"
    browser.click('[data-mode="wipe"]')
    browser.drag(x + width * 0.2, y + height / 3, x + width * 0.7, y + height / 3)
    left = (int(width * 0.25), int(height * 0.3), int(width * 0.65), int(height * 0.9))
    assert difference(first, shot("error-wipe"), left) > 5, "the left picture's error map shows"
    browser.click(".errors")
    browser.value("document.querySelector('.stage').focus()")
    before = browser.value("document.querySelector('.viewer .tile img').style.transform")
    browser.mouse("mouseWheel", x + width * 0.6, y + height * 0.4, deltaX=0, deltaY=-480)
    transforms = browser.value("[...new Set([...document.querySelectorAll('.viewer img')].map(i => i.style.transform))]")
    assert len(transforms) == 1 and transforms[0] != before, f"all views zoom together: {transforms}"
    browser.shot(FOLDER / "zoomed.png", box)
    browser.click(".reset")


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
        for test in (test_everything_is_there, test_the_wipe, test_flip_maps_and_zoom, test_screenshots):
            test(browser)
            print(f"{test.__name__}: good")
    finally:
        browser.close()


if __name__ == "__main__":
    main()

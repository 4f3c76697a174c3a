#!/usr/bin/env python3
"""Opens a page of `limpid bench quality --report` in headless Chromium and uses it as a reader would: drags the
divider, presses keys, touches, chooses pictures and frames, plays, zooms, points at pixels,
changes the exposure. Exit code 0: as it should be; 1: not; 77: there is no Chromium."""

import json
import pathlib
import re
import sys
import tempfile
import time

from browser import NOT_TESTED, Browser, check, chromium

BOX = '''(() => {
  const box = document.querySelector('.compare'), left = box.querySelector('.left');
  const outer = box.getBoundingClientRect(), divider = box.querySelector('.divider').getBoundingClientRect();
  return {left: outer.left, top: outer.top, width: outer.width, height: outer.height,
          divider: divider.left + divider.width / 2 - outer.left, clip: getComputedStyle(left).clipPath,
          now: Number(box.querySelector('.divider').getAttribute('aria-valuenow')),
          first: left.toDataURL(), second: box.querySelector('.right').toDataURL(),
          tags: [...box.querySelectorAll('.tag')].map(tag => tag.textContent)};
})()'''


# A copy is read, so that the page's canvases stay as they are.
BYTES_OF = '''var bytesOf = (picture, x, y, width, height) => {
  const copy = document.createElement('canvas');
  copy.width = picture.naturalWidth || picture.width;
  copy.height = picture.naturalHeight || picture.height;
  const context = copy.getContext('2d', {willReadFrequently: true});
  context.drawImage(picture, 0, 0);
  return context.getImageData(x, y, width, height).data;
};
'''


def clipped_share(box):
    """How much of the left picture the computed clip leaves, by its own numbers."""
    numbers = re.search(r'inset\(0(?:px)? (.+?) 0(?:px)? 0(?:px)?\)|inset\(0(?:px)? (.+)\)', box['clip'])
    check(numbers, f'the left picture is not clipped: {box["clip"]}')
    right = next(group for group in numbers.groups() if group)
    percents = [float(p) for p in re.findall(r'([\d.]+)%', right)]
    hidden = percents[0] if len(percents) == 1 else percents[0] - percents[1]
    return 1 - hidden / 100


def check_cut(browser, share, how):
    box = browser.evaluate(BOX)
    check(abs(box['divider'] / box['width'] - share) < 0.01, f'{how}: the divider is at {box["divider"]} of {box["width"]}')
    check(abs(clipped_share(box) - share) < 0.01, f'{how}: the clip is {box["clip"]}')
    check(abs(box['now'] - 100 * share) <= 1, f'{how}: aria-valuenow is {box["now"]}')
    return box


def at(box, share):
    return box['left'] + share * box['width'], box['top'] + box['height'] / 2


def use_slider(browser):
    box = check_cut(browser, 0.5, 'at first')
    check(box['width'] > 100 and box['height'] > 50, f'the slider has no size: {box}')
    check(box['first'] != box['second'], 'both sides show one picture')
    before = browser.picture(box)
    browser.drag(at(box, 0.5), at(box, 0.2))
    moved = browser.picture(check_cut(browser, 0.2, 'dragged'))
    check(moved != before, 'dragging changed no pixel')
    browser.drag(at(box, 0.2), (box['left'] - 300, box['top'] + 5))
    check_cut(browser, 0, 'dragged out of the picture')
    for key, share in (('End', 1), ('Home', 0), ('ArrowRight', 0.01), ('PageUp', 0.11), ('ArrowLeft', 0.1)):
        browser.key(key)
        check_cut(browser, share, key)
    browser.touch(at(box, 0.1), at(box, 0.7))
    check_cut(browser, 0.7, 'touched')
    browser.mouse('mouseMoved', *at(box, 0.3), 0)
    check_cut(browser, 0.7, 'the mouse passing by')


def shown(browser):
    """What the first sequence shows: the texts, and every canvas after it was drawn."""
    browser.evaluate('new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))')
    return browser.evaluate('''(() => {
      const part = document.querySelector('.sequence'), text = name => part.querySelector(name).textContent;
      return {frame: text('.frame-number'), exposure: text('.exposure-number'), zoom: text('.zoom-number'),
              tags: [...part.querySelectorAll('.tag')].map(tag => tag.textContent),
              captions: [...part.querySelectorAll('.tiles:not(.maps) button')].map(tile => tile.innerText),
              canvases: [...part.querySelectorAll('canvas')].map(canvas => canvas.toDataURL())};
    })()''')


def alike(browser, one, other):
    """Whether the canvases show the same: resampling may differ by rounding once the browser changes how it draws."""
    pairs = json.dumps(list(zip(one['canvases'], other['canvases'])))
    return browser.evaluate(BYTES_OF + f'''Promise.all({pairs}.map(async pair => {{
      const [a, b] = await Promise.all(pair.map(async uri => {{
        const image = new Image();
        image.src = uri;
        await image.decode();
        return bytesOf(image, 0, 0, image.naturalWidth, image.naturalHeight);
      }}));
      return a.length === b.length && a.every((byte, i) => Math.abs(byte - b[i]) <= 2);
    }})).then(results => results.every(Boolean))''')


def wait_for_frame(browser, frame):
    browser.wait(f"document.querySelector('.frame-number').textContent === 'frame {frame}'", f'frame {frame} does not come')
    return shown(browser)


def use_choosers(browser):
    names = browser.evaluate("[...document.querySelector('.bar select').options].map(o => o.textContent)")
    check('noisy' in names and 'reference' in names, f'pictures to choose: {names}')
    before = browser.evaluate(BOX)
    browser.evaluate(f'''(() => {{
      const select = document.querySelectorAll('.pair select')[1];
      select.value = {names.index('reference')};
      select.dispatchEvent(new Event('change'));
    }})()''')
    browser.wait("document.querySelectorAll('.tag')[1].textContent === 'reference'", 'the reference does not come')
    shown(browser)
    check(browser.evaluate(BOX)['second'] != before['second'], 'the right picture stays')
    browser.click_on("document.querySelector('.maps button')")
    browser.wait("document.querySelectorAll('.tag')[1].textContent.startsWith('error of')",
                 'an error map does not come into the slider')


def use_frames(browser, first, last):
    browser.evaluate("document.querySelector('.compare').focus()")
    at_last = wait_for_frame(browser, last)
    browser.key('ArrowLeft')
    before = wait_for_frame(browser, last - 1)
    changed = [a != b for a, b in zip(at_last['canvases'], before['canvases'])]
    check(all(changed), f'another frame, canvases that changed: {changed}')
    check(before['captions'] != at_last['captions'], 'the scores below the pictures stay')
    browser.key('ArrowRight')
    check(alike(browser, wait_for_frame(browser, last), at_last), 'a frame differs when shown again')
    browser.key('ArrowRight')
    check(shown(browser)['frame'] == f'frame {last}', 'beyond the last frame')
    browser.evaluate("document.querySelector('input.frame').focus()")
    browser.key('Home')
    wait_for_frame(browser, first)
    browser.key('p')
    for frame in range(first + 1, last + 1):
        browser.wait(f"document.querySelector('.frame-number').textContent === 'frame {frame}'", f'playing: no {frame}')
    wait_for_frame(browser, first)
    browser.click_on("document.querySelector('button[aria-label=Stop]')")
    stopped = shown(browser)['frame']
    time.sleep(0.3)
    check(shown(browser)['frame'] == stopped, 'it plays on')
    browser.evaluate("document.querySelector('.compare').focus()")
    for label in ('Stop', 'Play'):
        browser.key(' ')
        browser.wait(f"document.querySelector('.viewer button').ariaLabel === '{label}'", f'the space bar: no {label}')


def use_keys(browser, names):
    seen = set()
    for number, name in enumerate(names, 1):
        browser.key(str(number))
        browser.wait(f"document.querySelectorAll('.tag')[1].textContent === {json.dumps(name)}", f'key {number}: no {name}')
        seen.add(shown(browser)['canvases'][0])
    check(len(seen) == len(names), 'number keys show the same picture')
    browser.key('d')
    check(browser.evaluate("getComputedStyle(document.querySelector('.left')).display") == 'none', 'D leaves the divider')
    browser.key('d')
    check(browser.evaluate("getComputedStyle(document.querySelector('.left')).display") != 'none', 'D brings no divider')


def crops_agree(browser, zoom):
    """Whether every canvas shows the part that the view says, by the colours of its middle pixel."""
    return browser.evaluate(BYTES_OF + '''(async () => {
      const data = JSON.parse(document.getElementById('data').textContent), scene = data.scenes[0];
      const at = Number(document.querySelector('.frame-number').textContent.split(' ')[1]) - scene.first_frame;
      const uris = [...scene.methods.map(m => m.pictures[at]), scene.reference_pictures[at]];
      const tiles = [...document.querySelector('.sequence').querySelectorAll('.tiles:not(.maps) canvas')];
      const [x, y] = document.querySelector('.readout th').textContent.match(/\\d+/g).map(Number);
      const result = [];
      for (const [index, canvas] of tiles.entries()) {
        const image = new Image();
        image.src = uris[index];
        await image.decode();
        const expected = [...bytesOf(image, x, y, 1, 1)].slice(0, 3).join(' ');
        const middle = [...bytesOf(canvas, canvas.width * VX, canvas.height * VY, 1, 1)].slice(0, 3);
        const told = document.querySelectorAll('.readout tbody tr')[index].cells[1].textContent;
        result.push({expected, shown: middle.join(' '), told});
      }
      return result;
    })()'''.replace('VX', str(zoom[0])).replace('VY', str(zoom[1])))


def use_zoom_and_pixels(browser):
    whole = shown(browser)
    box = browser.evaluate(BOX)
    place = (0.3, 0.4)
    point = (box['left'] + place[0] * box['width'], box['top'] + place[1] * box['height'])
    for _ in range(8):
        browser.call('Input.dispatchMouseEvent', type='mouseWheel', x=point[0], y=point[1], deltaX=0, deltaY=-100, modifiers=2)
    browser.wait("document.querySelector('.zoom-number').textContent === '16\u00d7'", 'the wheel does not zoom')
    browser.mouse('mouseMoved', point[0] + 1, point[1], 0)
    zoomed = shown(browser)
    check(all(a != b for a, b in zip(whole['canvases'], zoomed['canvases'])), 'not every picture is enlarged')
    rows = crops_agree(browser, place)
    check(len({row['expected'] for row in rows}) > 1, f'all pixels are alike: {rows}')
    for row in rows:
        check(row['expected'] == row['told'] == row['shown'], f'the pixel under the mouse: {row}')
    browser.drag(point, (point[0] - 100, point[1] - 40))
    moved = shown(browser)
    check(all(a != b for a, b in zip(moved['canvases'], zoomed['canvases'])), 'not every picture moves along')
    pixel = "document.querySelector('.readout th').textContent"
    before = browser.evaluate(pixel)
    browser.key('ArrowRight', modifiers=8)
    x, y = map(int, re.findall(r'\d+', before))
    check(browser.evaluate(pixel) == f'pixel {x + 1}, {y}', f'Shift and an arrow: {before}, {browser.evaluate(pixel)}')
    browser.key('0')
    check(shown(browser)['zoom'] == '1\u00d7', '0 does not show the whole picture')


def tap(browser, width, height):
    box = browser.evaluate(BOX)
    point = {'x': box['left'] + 0.6 * box['width'], 'y': box['top'] + 0.7 * box['height']}
    browser.touches('touchStart', (point['x'], point['y']))
    browser.touches('touchEnd')
    told = browser.evaluate("document.querySelector('.readout th').textContent")
    check(told == f'pixel {int(0.6 * width)}, {int(0.7 * height)}', f'a tap marks {told}')


def mean_of_first(browser):
    return browser.evaluate(BYTES_OF + '''(() => {
      const canvas = document.querySelector('.sequence .tiles canvas');
      const bytes = bytesOf(canvas, 0, 0, canvas.width, canvas.height);
      return bytes.reduce((sum, byte) => sum + byte, 0) / bytes.length;
    })()''')


def use_exposure(browser):
    browser.mouse('mouseMoved', 1, 1, 0)  # the mouse marks no other pixel meanwhile
    before, told = shown(browser), browser.evaluate("document.querySelector('.readout tbody').innerText")
    mean = mean_of_first(browser)
    browser.key('e')
    check(shown(browser)['exposure'] == '+0.50 stops' and mean_of_first(browser) > mean + 3, 'E does not brighten')
    browser.evaluate("document.querySelector('input.exposure').focus()")
    browser.key('Home')
    darkest = shown(browser)
    check(darkest['exposure'] == '\u22124.00 stops' and mean_of_first(browser) < mean - 10, 'the slider does not darken')
    check(browser.evaluate("document.querySelector('.readout tbody').innerText") == told, 'pixel values change')
    browser.click_on("[...document.querySelectorAll('button')].find(b => b.textContent === 'Reset')")
    browser.wait("document.querySelector('.exposure-number').textContent === '0.00 stops'", 'Reset leaves the exposure')
    check(alike(browser, shown(browser), before), 'exposure 0 is not what it was')


def use_plot(browser):
    path = "document.querySelector('svg .line').getAttribute('d')"
    before = browser.evaluate(path)
    check(before.count('L') > 0, f'the plot has no line: {before}')
    browser.evaluate('''(() => {
      const select = document.querySelector('select[aria-label=Metric]');
      select.value = 'flip';
      select.dispatchEvent(new Event('change'));
    })()''')
    check(browser.evaluate(path) != before, 'another metric has the same line')


def check_widths(browser):
    for width in (1200, 390):
        browser.size(width, 900)
        inner = browser.evaluate('document.scrollingElement.scrollWidth')
        check(inner <= width, f'at {width} pixels the page is {inner} wide')


def check_silence(browser, address):
    for event in browser.events:
        method, parameters = event.get('method'), event.get('params', {})
        if method == 'Network.requestWillBeSent':
            target = parameters['request']['url']
            check(target == address or target.startswith('data:'), f'the page asks for {target}')
        check(method != 'Runtime.exceptionThrown', f'exception: {parameters}')
        check(method != 'Runtime.consoleAPICalled' or parameters['type'] not in ('error', 'warning', 'assert'),
              f'console: {parameters}')
        check(method != 'Log.entryAdded' or parameters['entry']['level'] not in ('error', 'warning'),
              f'log: {parameters}')
    requests = [e for e in browser.events if e.get('method') == 'Network.requestWillBeSent']
    check(requests, 'requests were not watched')


def test(browser, address):
    for domain in ('Page', 'Runtime', 'Network', 'Log'):
        browser.call(f'{domain}.enable')
    browser.size(1200, 3000)  # large enough that nothing must be scrolled
    browser.call('Page.navigate', url=address)
    browser.evaluate('''new Promise(done => document.readyState === 'complete' ? done() : addEventListener('load', done))
''')
    browser.wait("document.querySelector('.sequence .tiles canvas').getAttribute('aria-label')", 'no picture is shown')
    check_silence(browser, address)
    pictures = len(shown(browser)['canvases'])
    check(pictures >= 7, f'pictures: {pictures}')
    data = browser.evaluate('''(() => { const {width, height, scenes: [scene]} = JSON.parse(document.getElementById('data').textContent);
      return {width, height, first: scene.first_frame, last: scene.frames - 1, names: scene.methods.map(m => m.method)}; })()''')
    use_slider(browser)
    use_choosers(browser)
    use_frames(browser, data['first'], data['last'])
    use_keys(browser, data['names'] + ['reference'])
    use_zoom_and_pixels(browser)
    tap(browser, data['width'], data['height'])
    use_exposure(browser)
    use_plot(browser)
    check_widths(browser)
    check_silence(browser, address)


def main():
    program = chromium()
    if not program:
        return NOT_TESTED
    address = pathlib.Path(sys.argv[1]).resolve().as_uri()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            test(browser, address)
        except (AssertionError, RuntimeError) as fault:
            print(fault)
            return 1
        finally:
            browser.close()
    return 0


if __name__ == '__main__':
    sys.exit(main())

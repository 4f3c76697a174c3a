#!/usr/bin/env python3
"""Opens a page of `limpid bench quality --report` in headless Chromium and uses it as a reader would: drags the
divider, presses keys, touches, chooses pictures. Exit code 0: as it should be; 1: not; 77: there is no Chromium."""

import pathlib
import re
import sys
import tempfile

from browser import NOT_TESTED, Browser, check, chromium

BOX = '''(() => {
  const box = document.querySelector('.compare'), left = box.querySelector('.left');
  const outer = box.getBoundingClientRect(), divider = box.querySelector('.divider').getBoundingClientRect();
  return {left: outer.left, top: outer.top, width: outer.width, height: outer.height,
          divider: divider.left + divider.width / 2 - outer.left, clip: getComputedStyle(left).clipPath,
          now: Number(box.querySelector('.divider').getAttribute('aria-valuenow')),
          first: left.currentSrc, second: box.querySelector('.right').currentSrc,
          tags: [...box.querySelectorAll('.tag')].map(tag => tag.textContent)};
})()'''


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


def use_choosers(browser):
    names = browser.evaluate("[...document.querySelector('.bar select').options].map(o => o.textContent)")
    check('noisy' in names and 'reference' in names, f'pictures to choose: {names}')
    before = browser.evaluate(BOX)
    browser.evaluate(f'''(() => {{
      const select = document.querySelectorAll('.bar select')[1];
      select.value = {names.index('reference')};
      select.dispatchEvent(new Event('change'));
      return Promise.all([...document.images].map(image => image.decode()));
    }})()''')
    after = browser.evaluate(BOX)
    check(after['second'] != before['second'] and after['tags'][1] == 'reference', f'chosen: {after["tags"]}')
    browser.evaluate("document.querySelector('.maps button').click()")
    check(browser.evaluate(BOX)['tags'][1].startswith('error of'), 'an error map does not come into the slider')


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
      .then(() => Promise.allSettled([...document.images].map(image => image.decode())))''')
    check_silence(browser, address)
    pictures = browser.evaluate('[...document.images].map(image => image.naturalWidth)')
    check(len(pictures) >= 4 and min(pictures) > 0, f'pictures: {pictures}')
    use_slider(browser)
    use_choosers(browser)
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

#!/usr/bin/env python3
"""Uses the page of `limpid serve` in headless Chromium with a real mouse, fingers and keys, against the real program.

    serve_page_browser.py LIMPID FOLDER

Exit code 0: as it should be; 1: not; 77: there is no Chromium, or no `limpid serve`."""

import base64
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

from browser import NOT_TESTED, Browser, check, chromium

SCENE = 'builtin:cornell'
SAMPLES = 4
PHONE = (390, 844)


class Server:
    """`limpid serve`, always at the same port."""

    def __init__(self, program, folder):
        self.program, self.port, self.process = program, 0, None
        # The exposure would be measured in the first frame, whose size is another one in the window.
        self.state = pathlib.Path(folder) / 'state.json'
        self.state.write_text('{"limpid_state": 1, "exposure": 1.5}')

    def options(self):
        return [SCENE, '--device', 'cpu', '--max-spp', str(SAMPLES), '--state', str(self.state)]

    def start(self):
        self.process = subprocess.Popen(
            [self.program, 'serve', *self.options(), '--port', str(self.port), '--uploads', '1'],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.stderr.read())
        self.port = int(re.search(r':(\d+)/', self.address).group(1))

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(30)
        check(code == 0, f'limpid serve ends with {code}: {self.process.stderr.read()}')


class Relay:
    """Stands between the browser and the program, as a network that can be cut."""

    def __init__(self, server):
        self.server, self.open, self.sockets = server, True, set()
        self.listener = socket.create_server(('127.0.0.1', 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def address(self):
        return self.server.address.replace(f':{self.server.port}/', f':{self.port}/')

    def accept(self):
        while True:
            near, _ = self.listener.accept()
            try:
                far = socket.create_connection(('127.0.0.1', self.server.port)) if self.open else None
            except OSError:
                far = None
            if not far:
                near.close()
                continue
            self.sockets |= {near, far}
            for source, target in ((near, far), (far, near)):
                threading.Thread(target=self.forward, args=(source, target), daemon=True).start()

    def forward(self, source, target):
        try:
            while data := source.recv(1 << 16):
                target.sendall(data)
        except OSError:
            pass
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # it is closed

    def cut(self):
        self.open = False
        for end in list(self.sockets):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # it is closed
        self.sockets.clear()


# ---- What the page shows

def field(key):
    return 'field-' + re.sub('[^a-z0-9]', '-', key, flags=re.I)


def value_of(browser, key):
    return browser.evaluate(f"document.getElementById('{field(key)}-number').valueAsNumber")


def box_of(browser, selector):
    """Scrolls the element into view."""
    return browser.evaluate(f'''(() => {{
      const element = document.querySelector({json.dumps(selector)});
      for (let each = element; each; each = each.parentElement) if (each.tagName === 'DETAILS') each.open = true;
      element.scrollIntoView({{block: 'center'}});
      const {{left, top, width, height}} = element.getBoundingClientRect();
      return {{left, top, width, height}};
    }})()''')


def center(box):
    return box['left'] + box['width'] / 2, box['top'] + box['height'] / 2


def click_on(browser, selector):
    browser.click(*center(box_of(browser, selector)))


def type_into(browser, selector, text):
    browser.click(*center(box_of(browser, selector)), count=3)
    browser.type(text)
    browser.key('Enter')


def choose(browser, key, text):
    """A list of choices opens outside of the page: it is set, and says so."""
    browser.evaluate(f'''(() => {{
      const select = document.getElementById('{field(key)}');
      select.selectedIndex = [...select.options].findIndex(option => option.textContent === '{text}');
      select.dispatchEvent(new Event('change'));
    }})()''')


PIXELS = '''const canvas = document.getElementById('picture');
const pixels = () => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => {
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d', {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  done(copy.getImageData(0, 0, canvas.width, canvas.height));
})));
const difference = (a, b) => {
  let sum = 0, largest = 0, mean = 0;
  for (let i = 0; i < a.data.length; ++i) {
    const d = Math.abs(a.data[i] - b.data[i]);
    sum += d;
    mean += a.data[i];
    largest = Math.max(largest, d);
  }
  return {mean: sum / a.data.length, largest, brightness: mean / a.data.length};
};
const decoded = async url => {
  const image = await createImageBitmap(await (await fetch(url)).blob());
  const other = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
  other.drawImage(image, 0, 0);
  return {width: image.width, height: image.height, data: other.getImageData(0, 0, canvas.width, canvas.height).data};
};
'''


def evaluate(browser, body):
    return browser.evaluate(f'(async () => {{ {PIXELS} {body} }})()')


def settle(browser, what):
    """Until the lossless picture is there."""
    browser.wait("document.querySelector('#stage').dataset.lossless === 'true' && "
                 "document.querySelector('#activity').textContent.match(/finished|stopped/)", what, 30)


def open_page(browser, address):
    for domain in ('Page', 'Runtime', 'Network', 'Log'):
        browser.call(f'{domain}.enable')
    browser.call('Page.navigate', url=address)
    browser.wait("document.querySelector('#stage.has-picture') !== null", 'the first picture', 40)


def fit_stage(browser, width=480, height=200):
    """Makes the window as large as it must be for a picture of this size, beside the controls."""
    window = [900, 600]
    for _ in range(3):
        browser.size(*window)
        box = browser.evaluate('''(({clientWidth, clientHeight}) => [clientWidth, clientHeight])
            (document.getElementById('stage'))''')
        window = [window[0] + width - box[0], window[1] + height - box[1]]
    browser.wait(f"document.getElementById('picture').width === {width}", 'the size of the canvas')
    shown = "document.getElementById('fact-size').textContent"
    browser.wait(f"{shown} === '{width} × {height}'", 'the picture of this size', 40)


# ---- The tests

def test_picture(browser, address):
    extent = browser.evaluate("[document.getElementById('picture').width, document.getElementById('picture').height]")
    kind = browser.evaluate("document.getElementById('stage').dataset.kind")
    settle(browser, 'a finished picture')
    difference = evaluate(browser, '''const url = '/picture.png' + location.search, png = await decoded(url);
      return {...difference(await pixels(), png), size: [png.width, png.height]};''')
    check(difference['size'] == extent, f'the PNG has {difference["size"]}, the canvas {extent}')
    check(difference['largest'] == 0, f'the canvas is not the downloaded PNG: {difference}')
    check(difference['brightness'] > 20, f'the picture is dark: {difference}')
    check(kind in ('vp9', 'png'), f'with WebCodecs the first pictures are {kind}')
    return extent


def test_video(browser, kind):
    """The last picture of the video is that which rests, up to what compression loses. The preview has no noise."""
    choose(browser, 'integrator', 'preview')
    result = evaluate(browser, '''const stage = document.getElementById('stage');
      let last = null, kinds = new Set();
      const watch = new MutationObserver(async () => {
        kinds.add(stage.dataset.kind);
        if (stage.dataset.lossless === 'false') last = await pixels();
      });
      watch.observe(stage, {attributes: true, attributeFilter: ['data-frame']});
      document.querySelector('[data-request=reset]').click();
      const end = performance.now() + 15000;
      const finished = () => last && stage.dataset.lossless === 'true';
      while (!finished() && performance.now() < end) await new Promise(done => setTimeout(done, 50));
      watch.disconnect();
      return last && {...difference(last, await pixels()), kinds: [...kinds]};''')
    check(result and kind in result['kinds'], f'{kind} did not come: {result}')
    check(result['mean'] < 2.5 and result['brightness'] > 20, f'{kind} is far from the lossless picture: {result}')
    choose(browser, 'integrator', 'path')
    chosen = "document.getElementById('field-integrator').selectedOptions[0].textContent"
    browser.wait(f"{chosen} === 'path'", 'the integrator')
    settle(browser, 'the path tracer')


def test_against_window(browser, server, program, folder, extent):
    """`limpid view` makes the same picture in a window."""
    if not shutil.which('Xvfb'):
        print('NOT TESTED: the picture of the window (Debian: xvfb)')
        return
    screenshot = pathlib.Path(folder) / 'window.png'
    reading, writing = os.pipe()
    display = subprocess.Popen(['Xvfb', '-displayfd', str(writing), '-screen', '0', '1000x800x24'], pass_fds=[writing],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(writing)
    try:
        number = os.read(reading, 20).decode().strip()
        result = subprocess.run(
            [program, 'view', *server.options(), '--settings', 'none', '--shrink', '0', '--width', str(extent[0]),
             '--height', str(extent[1]), '--frames', str(SAMPLES), '--screenshot', str(screenshot)],
            env={**os.environ, 'DISPLAY': ':' + number}, capture_output=True, text=True, timeout=60)
    finally:
        os.close(reading)
        display.terminate()
        display.wait()
    if 'was built without' in result.stderr:
        print('NOT TESTED: the picture of the window: ' + result.stderr)
        return
    check(screenshot.exists(), f'limpid view made no picture: {result.stdout} {result.stderr}')
    url = 'data:image/png;base64,' + base64.b64encode(screenshot.read_bytes()).decode()
    difference = evaluate(browser, f'''const bytes = Uint8Array.from(atob('{url.split(',')[1]}'), c => c.charCodeAt(0));
      const url = URL.createObjectURL(new Blob([bytes], {{type: 'image/png'}}));
      const image = new Image();
      image.src = url;
      await image.decode();
      const other = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
      other.drawImage(image, 0, 0);
      return {{...difference(await pixels(), other.getImageData(0, 0, canvas.width, canvas.height)),
              size: [image.width, image.height]}};''')
    check(difference['size'] == extent, f"the window's picture has {difference['size']}")
    check(difference['mean'] < 0.2 and difference['largest'] <= 2, f'the window shows another picture: {difference}')


def test_controls(browser):
    type_into(browser, '#field-seed-number', '7')
    browser.wait("document.querySelector('[data-key=seed]').classList.contains('changed')", 'the mark of a change')
    browser.wait("document.getElementById('activity').textContent === 'finished'", 'the changed picture', 30)
    click_on(browser, '[data-key=seed] .reset')
    check(value_of(browser, 'seed') == 0, 'the default does not come back')
    check(not browser.evaluate("document.querySelector('[data-key=seed].changed') !== null"), 'the mark stays')
    browser.evaluate("document.activeElement.blur()")
    browser.key('z', 2)
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 7", 'undo')
    browser.key('z', 2)
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 0", 'undo, twice')
    browser.key('z', 10)
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 7", 'redo')
    browser.key('z', 2)


def test_search(browser):
    click_on(browser, '#search')
    browser.type('exposure')
    shown = browser.evaluate('''[...document.querySelectorAll('.field[data-key]')]
        .filter(f => f.offsetParent).map(f => f.dataset.key)''')
    check('exposure' in shown and 'seed' not in shown and len(shown) < 10, f'found: {shown}')
    found = browser.evaluate("document.getElementById('search-result').textContent")
    check(found == f'{len(shown)} found', f'it says {found}')
    browser.evaluate("document.getElementById('search').value = ''")
    browser.type(' ')
    check(browser.evaluate("document.querySelector('[data-key=seed]').offsetParent !== null"), 'the search stays')


def test_keyboard_slider(browser):
    """From the search, by the tabulator only."""
    browser.evaluate("document.getElementById('search').focus()")
    for _ in range(80):
        browser.key('Tab')
        if browser.evaluate("document.activeElement.id") == 'field-exposure':
            break
    else:
        raise AssertionError('the tabulator does not reach the slider')
    outline = browser.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    check(outline != 'none', 'the focus is not visible')
    before = value_of(browser, 'exposure')
    for _ in range(3):
        browser.key('ArrowRight')
    after = value_of(browser, 'exposure')
    check(after > before, f'the arrow key changes {before} to {after}')
    text = browser.evaluate("document.activeElement.getAttribute('aria-valuetext')")
    check('stops' in text, f'the slider says {text}')
    browser.evaluate("document.activeElement.blur()")
    browser.key('z', 2)
    browser.wait(f"Math.abs(document.getElementById('field-exposure-number').valueAsNumber - {before}) < 1e-3", 'undo')


EYE = "['', '-y', '-z'].map(axis => document.getElementById('field-eye' + axis).valueAsNumber)"


def moved(browser, what, act):
    before = browser.evaluate(EYE)
    act()
    browser.wait(f"({EYE}).some((v, i) => Math.abs(v - {json.dumps(before)}[i]) > 1e-3)", what)


def test_camera(browser):
    x, y = center(browser.evaluate('''(({left, top, width, height}) => ({left, top, width, height}))
        (document.getElementById('stage').getBoundingClientRect())'''))
    before = browser.evaluate(EYE)
    moved(browser, 'orbiting', lambda: browser.drag((x, y), (x + 60, y + 10)))
    browser.wait("document.getElementById('undo').title.includes('eye')", 'a movement as a step of undo')
    undone = browser.evaluate(EYE)
    click_on(browser, '#undo')
    browser.wait(f"({EYE}).every((v, i) => Math.abs(v - {json.dumps(before)}[i]) < 1e-3)", 'the movement, undone')
    click_on(browser, '#redo')
    browser.wait(f"({EYE}).every((v, i) => Math.abs(v - {json.dumps(undone)}[i]) < 1e-3)", 'the movement, done again')
    moved(browser, 'the wheel', lambda: browser.wheel(x, y, -200))
    moved(browser, 'flying', lambda: [browser.call('Input.dispatchKeyEvent', type='keyDown', key='w', code='KeyW'),
                                      time.sleep(0.2),
                                      browser.call('Input.dispatchKeyEvent', type='keyUp', key='w', code='KeyW')])
    target = browser.evaluate("document.getElementById('field-target').value")
    browser.click(x - 70, y - 30, count=2)
    browser.wait(f"document.getElementById('field-target').value !== '{target}'", 'a double click')
    click_on(browser, '[data-request=reset_camera]')
    browser.wait(f"({EYE}).every((v, i) => Math.abs(v - {json.dumps(before)}[i]) < 1e-3)", 'the first camera')
    browser.wheel(x, y, -400, control=True)
    browser.wait("parseFloat(document.getElementById('unzoom').textContent) > 1", 'larger pixels')
    click_on(browser, '#unzoom')
    browser.evaluate("document.getElementById('stage').focus()")
    browser.type(' ')
    browser.wait("document.getElementById('run').textContent === 'Run'", 'Space')
    browser.type(' ')
    browser.wait("document.getElementById('run').textContent === 'Stop'", 'Space, again')
    browser.type('?')
    check(browser.evaluate("document.getElementById('keys').open"), 'the list of keys does not open')
    browser.key('Escape')
    check(not browser.evaluate("document.getElementById('keys').open"), 'the list of keys does not close')


def test_comparison(browser):
    settle(browser, 'the picture alone')
    choose(browser, 'compare', 'gbuffer')
    browser.wait("!document.getElementById('divider').hidden", 'the compared picture', 30)
    shares = evaluate(browser, '''const one = await pixels();
      document.getElementById('divider').focus();
      return [one.width, document.getElementById('name-right').textContent];''')
    check(shares[1], 'the compared picture has no name')
    browser.wait("document.getElementById('stage').dataset.comparedLossless === 'true'", 'the compared picture at rest')
    settle(browser, 'both pictures')
    evaluate(browser, 'window.before = await pixels();')
    box = box_of(browser, '#divider')
    stage = browser.evaluate("document.getElementById('stage').getBoundingClientRect().width")
    x, y = center(box)
    browser.drag((x, y), (x - 0.3 * stage, y))
    now = browser.evaluate("Number(document.getElementById('divider').getAttribute('aria-valuenow'))")
    check(abs(now - 20) <= 1, f'the divider is dragged to {now}')
    changed = evaluate(browser, '''const now = await pixels(), {width, height} = now;
      const strip = (a, from, to) => {
        let sum = 0, count = 0;
        for (let y = 0; y < height; ++y) for (let x = Math.round(from * width); x < to * width; ++x, ++count)
          for (let i = 4 * (y * width + x), c = 0; c < 3; ++c) sum += Math.abs(a.data[i + c] - before.data[i + c]);
        return sum / count;
      };
      return [strip(now, 0, 0.19), strip(now, 0.22, 0.48), strip(now, 0.52, 1)];''')
    check(changed[1] > 5 and changed[0] < 1 and changed[2] < 1, f'the divider shows the wrong sides: {changed}')
    browser.key('ArrowRight')
    after = browser.evaluate("Number(document.getElementById('divider').getAttribute('aria-valuenow'))")
    check(after == now + 1, f'a key moves the divider from {now} to {after}')
    choose(browser, 'compare', 'nothing')
    browser.wait("document.getElementById('divider').hidden", 'the end of the comparison')


def test_upload(browser, folder):
    """A scene of this device, dropped on the picture."""
    before = browser.evaluate("document.getElementById('scene-name').textContent")
    file = pathlib.Path(folder) / 'dropped.obj'
    file.write_text('v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n')
    x, y = center(box_of(browser, '#stage'))
    data = {'items': [], 'files': [str(file)], 'dragOperationsMask': 1}
    for kind in ('dragEnter', 'dragOver', 'drop'):
        browser.call('Input.dispatchDragEvent', type=kind, x=x, y=y, data=data)
    browser.wait("document.getElementById('scene-name').textContent.includes('dropped')", 'the dropped scene')
    browser.evaluate('''(() => {
      const select = document.getElementById('open-scene');
      select.value = [...select.options].map(o => o.value).find(value => value === 'builtin:cornell');
      select.dispatchEvent(new Event('change'));
    })()''')
    browser.wait(f"document.getElementById('scene-name').textContent === {json.dumps(before)}", 'the first scene')
    settle(browser, 'the first scene')


def test_two_tabs(browser, address):
    """Edits are seen in the other page, but not where a hand is on the control."""
    first = browser.open_tab()
    second = browser.session
    browser.size(900, 400)
    open_page(browser, address)
    type_into(browser, '#field-seed-number', '11')
    browser.session = first
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 11", "the other page's edit")
    slider = box_of(browser, '#field-exposure')
    x, y = slider['left'] + 0.75 * slider['width'], slider['top'] + slider['height'] / 2
    browser.mouse('mousePressed', x, y, 1)
    held = value_of(browser, 'exposure')
    browser.session = second
    now = "document.getElementById('field-exposure-number').valueAsNumber"
    browser.wait(f"Math.abs({now} - {held}) < 1e-3", 'the slider')
    type_into(browser, '#field-exposure-number', '-2')
    check(value_of(browser, 'exposure') == -2, 'what was typed is lost')
    browser.session = first
    time.sleep(0.5)
    check(value_of(browser, 'exposure') == held, 'a held slider jumps')
    browser.mouse('mouseReleased', x, y, 0)
    browser.wait("document.getElementById('field-exposure-number').valueAsNumber === -2", 'the slider, let go')
    click_on(browser, '[data-key=exposure] .reset')
    click_on(browser, '[data-key=seed] .reset')
    browser.session = second
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 0", "the first page's edit")
    browser.call('Page.close')
    browser.session = first


def test_reconnection(browser, relay):
    """A cut network: the page says so, and connects by itself."""
    relay.cut()
    browser.wait("document.body.classList.contains('lost')", 'the page does not see that the connection is lost')
    said = browser.evaluate("document.getElementById('connection').textContent")
    check('connecting again' in said, f'it says {said}')
    browser.evaluate("document.getElementById('stage').dataset.frame = ''")
    relay.open = True
    browser.wait("!document.body.classList.contains('lost')", 'the page does not connect again')
    browser.wait("document.getElementById('stage').dataset.frame !== ''", 'no picture after connecting again')
    type_into(browser, '#field-seed-number', '5')
    browser.wait("document.getElementById('activity').textContent === 'finished'", 'the changed picture')
    click_on(browser, '[data-key=seed] .reset')


def test_restart(browser, server, relay):
    """A program that is started again has another token: the page says where to go, which works."""
    server.stop()
    browser.wait("document.body.classList.contains('lost')", 'the page does not see that the program has ended')
    server.start()
    browser.wait("document.getElementById('connection').textContent.includes('open the address that it prints')",
                 'the page does not say where to go')
    open_page(browser, relay.address())
    check(browser.evaluate("!document.body.classList.contains('lost')"), 'the new address does not work')


def test_phone(browser):
    browser.size(*PHONE, mobile=True)
    layout = browser.wait('''(() => {
      const box = id => document.getElementById(id).getBoundingClientRect(), stage = box('stage'), panel = box('panel');
      const right = element => element.getBoundingClientRect().right;
      const wide = [...document.querySelectorAll('#panel *')].filter(element => right(element) > innerWidth + 1);
      return document.getElementById('picture').width === 390 &&
        {scroll: document.scrollingElement.scrollWidth, stage: [stage.width, stage.height],
         covered: panel.top < stage.bottom - 0.5, wide: wide.map(e => e.id || e.className)};
    })()''', 'the layout of a phone')
    check(layout['scroll'] <= PHONE[0], f'the page scrolls sideways: {layout}')
    check(not layout['covered'], f'the controls cover the picture: {layout}')
    check(not layout['wide'], f'controls are too wide: {layout}')
    check(layout['stage'][1] > 250, f'the picture is small: {layout}')
    settle(browser, 'the picture on a phone')
    moved(browser, 'one finger', lambda: browser.touch((150, 150), (200, 160)))

    def pinch():
        browser.touches('touchStart', (150, 150), (200, 150))
        for step in range(1, 6):
            browser.touches('touchMove', (150 - 10 * step, 150), (200 + 10 * step, 150))
        browser.touches('touchEnd')
    moved(browser, 'pinching', pinch)
    click_on(browser, '#toggle-panel')
    browser.wait("document.getElementById('stage').clientHeight > 650", 'the drawer does not close')
    below = browser.evaluate('''document.getElementById('bar').getBoundingClientRect().top -
        document.getElementById('panel').getBoundingClientRect().bottom''')
    check(below >= 0, f'messages cover the buttons by {-below} pixels')
    click_on(browser, '#toggle-panel')


def test_names(browser):
    """Whatever takes the focus has a name."""
    browser.evaluate("document.querySelectorAll('details').forEach(details => { details.open = true; })")
    nodes = browser.call('Accessibility.getFullAXTree')['nodes']
    def has(node, name):
        return any(p['name'] == name and p['value'].get('value') for p in node.get('properties', []))
    nodes = [n for n in nodes if not n.get('ignored') and n['role']['value'] != 'RootWebArea']
    focusable = [n for n in nodes if has(n, 'focusable')]
    check(len(focusable) > 50, f'only {len(focusable)} controls')
    nameless = [n['role']['value'] for n in focusable if not n.get('name', {}).get('value')]
    check(not nameless, f'controls without a name: {nameless}')


def test_contrast(browser):
    """Text on its background, in both schemes: WCAG's level AA."""
    for scheme in ('light', 'dark'):
        browser.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': scheme},
                                                             {'name': 'prefers-reduced-motion', 'value': 'reduce'}])
        faint = browser.evaluate('''(() => {
          const numbers = color => color.match(/[\\d.]+/g).map(Number);
          const luminance = color => numbers(color).slice(0, 3).map(v => v / 255)
              .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
              .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
          const behind = element => {
            for (; element; element = element.parentElement) {
              const color = getComputedStyle(element).backgroundColor;
              if (numbers(color)[3] !== 0) return color;
            }
            return 'rgb(255, 255, 255)';
          };
          const hasText = e => e.matches('input[type=number], input[type=search], select') ||
              [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim());
          const withText = [...document.querySelectorAll('#bar *, #panel *')]
              .filter(e => e.offsetParent && !e.disabled && hasText(e));
          const found = withText.map(element => {
            const [a, b] = [getComputedStyle(element).color, behind(element)].map(luminance).sort((x, y) => y - x);
            return {contrast: (a + 0.05) / (b + 0.05), what: element.id || element.textContent.slice(0, 30)};
          });
          return {count: found.length, faint: found.filter(f => f.contrast < 4.5)};
        })()''')
        check(faint['count'] > 100, f'only {faint["count"]} texts')
        check(not faint['faint'], f'{scheme}: faint texts: {faint["faint"]}')


def test_without_webcodecs(browser, address):
    script = browser.call('Page.addScriptToEvaluateOnNewDocument', source='delete window.VideoDecoder')['identifier']
    fit_stage(browser)
    open_page(browser, address)
    check(browser.evaluate("typeof VideoDecoder") == 'undefined', 'there still are WebCodecs')
    test_video(browser, 'jpeg')
    browser.call('Page.removeScriptToEvaluateOnNewDocument', identifier=script)


def check_silence(browser, relay):
    """No request to another place, and no error but that of a lost connection."""
    requests = 0
    for event in browser.events:
        method, parameters = event.get('method'), event.get('params', {})
        if method == 'Network.requestWillBeSent':
            url = parameters['request']['url']
            requests += 1
            check(url.startswith((f'http://127.0.0.1:{relay.port}/', 'data:', 'blob:')), f'the page asks for {url}')
        check(method != 'Runtime.exceptionThrown', f'exception: {parameters}')
        check(method != 'Runtime.consoleAPICalled' or parameters['type'] not in ('error', 'warning', 'assert'),
              f'console: {parameters}')
        if method == 'Log.entryAdded' and parameters['entry']['level'] in ('error', 'warning'):
            check('WebSocket' in parameters['entry']['text'], f'log: {parameters}')
    check(requests > 10, 'requests were not watched')


def check_policy(address):
    with urllib.request.urlopen(address) as answer:
        policy = answer.headers['Content-Security-Policy'] or ''
    check("default-src" in policy and 'unsafe' not in policy, f'the policy is {policy}')


def test(browser, server, program, folder):
    relay = Relay(server)
    address = relay.address()
    check_policy(address)
    timed('load', lambda: open_page(browser, address))
    fit_stage(browser)
    extent = timed('picture', lambda: test_picture(browser, address))
    timed('window', lambda: test_against_window(browser, server, program, folder, extent))
    timed('video', lambda: test_video(browser, 'vp9'))
    browser.size(900, 420)
    timed('controls', lambda: test_controls(browser))
    timed('search', lambda: test_search(browser))
    timed('keyboard', lambda: test_keyboard_slider(browser))
    fit_stage(browser)
    timed('camera', lambda: test_camera(browser))
    timed('comparison', lambda: test_comparison(browser))
    timed('upload', lambda: test_upload(browser, folder))
    timed('tabs', lambda: test_two_tabs(browser, address))
    timed('reconnection', lambda: test_reconnection(browser, relay))
    timed('phone', lambda: test_phone(browser))
    timed('names', lambda: test_names(browser))
    timed('contrast', lambda: test_contrast(browser))
    timed('jpeg', lambda: test_without_webcodecs(browser, address))
    timed('restart', lambda: test_restart(browser, server, relay))
    check_silence(browser, relay)


def timed(name, run):
    begin = time.monotonic()
    result = run()
    print(f'{name}: {time.monotonic() - begin:.1f} s', flush=True)
    return result


def main():
    program, folder = sys.argv[1:]
    browser_program = chromium()
    if not browser_program:
        return NOT_TESTED
    server = Server(program, folder)
    try:
        server.start()
    except RuntimeError as fault:
        print(fault)
        return NOT_TESTED if 'was built without' in str(fault) else 1
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(browser_program, profile)
        try:
            test(browser, server, program, folder)
            server.stop()
        except (AssertionError, RuntimeError) as fault:
            print(fault)
            return 1
        finally:
            browser.close()
            if server.process.poll() is None:
                server.process.kill()
                server.process.wait()
    return 0


if __name__ == '__main__':
    sys.exit(main())

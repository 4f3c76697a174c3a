"""For tests of pages: Chromium, driven by the DevTools protocol as a user would, with a real mouse, fingers and keys."""

import base64
import json
import os
import select
import shutil
import subprocess
import time

NOT_TESTED = 77  # exit code of a test that finds no Chromium


def chromium():
    """The program's path, or None, which is reported."""
    program = next(filter(None, map(shutil.which, ('chromium', 'chromium-browser', 'google-chrome'))), None)
    if not program:
        print('NOT TESTED: there is no Chromium on this machine (Debian: chromium)')
    return program


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Browser:
    """Chromium and one page of it, by the DevTools protocol over a pair of pipes."""

    def __init__(self, program, profile):
        to_browser, self.output = os.pipe()
        self.input, from_browser = os.pipe()

        def place_pipes():
            # Chromium reads commands from descriptor 3 and writes answers to descriptor 4.
            reading, writing = os.dup(to_browser), os.dup(from_browser)
            os.dup2(reading, 3)
            os.dup2(writing, 4)

        arguments = ['--headless=new', '--no-sandbox', '--disable-gpu', '--remote-debugging-pipe', '--no-first-run',
                     '--disable-background-networking', '--disable-component-update', '--disable-dev-shm-usage',
                     '--force-device-scale-factor=1', f'--user-data-dir={profile}', 'about:blank']
        self.process = subprocess.Popen([program, *arguments], preexec_fn=place_pipes, close_fds=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.rest = b''
        self.number = 0
        self.session = None
        self.events = []
        targets = self.call('Target.getTargets')['targetInfos']
        page = next(target['targetId'] for target in targets if target['type'] == 'page')
        self.session = self.call('Target.attachToTarget', targetId=page, flatten=True)['sessionId']

    def message(self, deadline):
        while b'\0' not in self.rest:
            ready, _, _ = select.select([self.input], [], [], max(0, deadline - time.monotonic()))
            data = os.read(self.input, 1 << 20) if ready else b''
            if not data:
                raise RuntimeError('the browser does not answer')
            self.rest += data
        text, self.rest = self.rest.split(b'\0', 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        command = {'id': self.number, 'method': method, 'params': parameters}
        if self.session:
            command['sessionId'] = self.session
        data = json.dumps(command).encode() + b'\0'
        while data:
            data = data[os.write(self.output, data):]
        deadline = time.monotonic() + 60
        while True:
            message = self.message(deadline)
            if message.get('id') == self.number:
                if 'error' in message:
                    raise RuntimeError(f'{method}: {message["error"]}')
                return message['result']
            self.events.append(message)

    def evaluate(self, expression):
        result = self.call('Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True)
        if 'exceptionDetails' in result:
            raise RuntimeError(f'{expression}: {result["exceptionDetails"]}')
        return result['result'].get('value')

    def open_tab(self):
        """Another page, which commands go to from now on; the earlier one's session is returned."""
        earlier, self.session = self.session, None
        page = self.call('Target.createTarget', url='about:blank')['targetId']
        self.session = self.call('Target.attachToTarget', targetId=page, flatten=True)['sessionId']
        return earlier

    def wait(self, expression, what, seconds=120):
        """Until the expression is true in the page; its value is returned."""
        deadline = time.monotonic() + seconds
        while True:
            value = self.evaluate(expression)
            if value:
                return value
            check(time.monotonic() < deadline, f'{what}: {expression} stays {value!r}')
            time.sleep(0.03)

    def size(self, width, height, mobile=False):
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.call('Emulation.setTouchEmulationEnabled', enabled=mobile)

    def mouse(self, kind, x, y, buttons, count=1):
        self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left', buttons=buttons, clickCount=count)

    def click(self, x, y, count=1):
        for n in range(1, count + 1):
            self.mouse('mousePressed', x, y, 1, n)
            self.mouse('mouseReleased', x, y, 0, n)

    def click_on(self, expression):
        """Clicks the middle of an element as the mouse does."""
        x, y = self.evaluate(f'''(() => {{ const b = ({expression}).getBoundingClientRect();
          return [b.left + b.width / 2, b.top + b.height / 2]; }})()''')
        self.mouse('mouseMoved', x, y, 0)
        self.click(x, y)

    def wheel(self, x, y, delta, control=False):
        self.call('Input.dispatchMouseEvent', type='mouseWheel', x=x, y=y, deltaX=0, deltaY=delta,
                  modifiers=2 if control else 0)

    def drag(self, start, end):
        self.mouse('mouseMoved', *start, 0)
        self.mouse('mousePressed', *start, 1)
        for step in range(1, 6):
            self.mouse('mouseMoved', *(a + (b - a) * step / 5 for a, b in zip(start, end)), 1)
        self.mouse('mouseReleased', *end, 0)

    def touch(self, start, end):
        self.call('Input.dispatchTouchEvent', type='touchStart', touchPoints=[{'x': start[0], 'y': start[1]}])
        for step in range(1, 6):
            x, y = (a + (b - a) * step / 5 for a, b in zip(start, end))
            self.call('Input.dispatchTouchEvent', type='touchMove', touchPoints=[{'x': x, 'y': y}])
        self.call('Input.dispatchTouchEvent', type='touchEnd', touchPoints=[])

    def touches(self, kind, *points):
        self.call('Input.dispatchTouchEvent', type=kind,
                  touchPoints=[{'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(points)])

    def key(self, name, modifiers=0):
        """A key without a character, or with modifiers: 2 is Ctrl, 8 Shift."""
        numbers = {'Tab': 9, 'Enter': 13, 'Escape': 27, 'ArrowLeft': 37, 'ArrowUp': 38, 'ArrowRight': 39,
                   'ArrowDown': 40}
        code = 'Key' + name.upper() if len(name) == 1 else name
        text = {'text': '\r'} if name == 'Enter' else {}
        for kind in ('keyDown', 'keyUp'):
            self.call('Input.dispatchKeyEvent', type=kind, key=name, code=code, modifiers=modifiers,
                      windowsVirtualKeyCode=numbers.get(name, ord(name.upper()) if len(name) == 1 else 0), **text)

    def type(self, text):
        for character in text:
            code = f'Key{character.upper()}' if character.isalpha() else 'Space' if character == ' ' else ''
            self.call('Input.dispatchKeyEvent', type='keyDown', key=character, code=code, text=character)
            self.call('Input.dispatchKeyEvent', type='keyUp', key=character, code=code)

    def picture(self, box):
        clip = {'x': box['left'], 'y': box['top'], 'width': box['width'], 'height': box['height'], 'scale': 1}
        return base64.b64decode(self.call('Page.captureScreenshot', format='png', clip=clip)['data'])

    def close(self):
        try:
            self.session = None
            self.call('Browser.close')
            self.process.wait(20)
        except (RuntimeError, OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        os.close(self.input)
        os.close(self.output)

"""The pixels of the canvas: those of the downloaded PNG, of the window, and of the video."""

import base64
import os
import pathlib
import shutil
import subprocess

from browser import check
from page import choose, evaluate, fit_stage, open_page, settle
from server import SAMPLES


def test_picture(browser, address):
    extent = browser.evaluate("[document.getElementById('picture').width, document.getElementById('picture').height]")
    settle(browser, 'a finished picture')
    difference = evaluate(browser, '''const url = '/picture.png' + location.search, png = await decoded(url);
      return {...difference(await pixels(), png), size: [png.width, png.height]};''')
    check(difference['size'] == extent, f'the PNG has {difference["size"]}, the canvas {extent}')
    check(difference['largest'] == 0, f'the canvas is not the downloaded PNG: {difference}')
    check(difference['brightness'] > 20, f'the picture is dark: {difference}')
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


def test_without_webcodecs(browser, address):
    script = browser.call('Page.addScriptToEvaluateOnNewDocument', source='delete window.VideoDecoder')['identifier']
    fit_stage(browser)
    open_page(browser, address)
    check(browser.evaluate("typeof VideoDecoder") == 'undefined', 'there still are WebCodecs')
    test_video(browser, 'jpeg')
    browser.call('Page.removeScriptToEvaluateOnNewDocument', identifier=script)

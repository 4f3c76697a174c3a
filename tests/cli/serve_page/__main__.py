#!/usr/bin/env python3
"""Uses the page of `limpid serve` in headless Chromium with a real mouse, fingers and keys, against the real program.

    serve_page LIMPID FOLDER

Exit code 0: as it should be; 1: not; 77: there is no Chromium, or no `limpid serve`."""

import pathlib
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))

import access
import camera
import comparison
import controls
import inspection
import pictures
import sessions
from browser import NOT_TESTED, Browser, chromium
from page import fit_stage, open_page
from server import Relay, Server


def test(browser, server, program, folder):
    relay = Relay(server)
    address = relay.address()
    access.check_policy(address)
    timed('load', lambda: open_page(browser, address))
    fit_stage(browser)
    extent = timed('picture', lambda: pictures.test_picture(browser, address))
    timed('window', lambda: pictures.test_against_window(browser, server, program, folder, extent))
    timed('video', lambda: pictures.test_video(browser, 'vp9'))
    browser.size(900, 420)
    timed('controls', lambda: controls.test_controls(browser))
    timed('steps', lambda: controls.test_steps(browser))
    timed('colors', lambda: controls.test_colors(browser))
    timed('lights', lambda: controls.test_lights(browser))
    timed('method before preview', lambda: controls.test_method_before_preview(browser))
    timed('search', lambda: controls.test_search(browser))
    timed('presets', lambda: controls.test_presets(browser))
    timed('parts', lambda: controls.test_parts(browser))
    timed('messages', lambda: controls.test_messages(browser))
    timed('keyboard', lambda: controls.test_keyboard_slider(browser))
    fit_stage(browser)
    timed('camera', lambda: camera.test_camera(browser))
    timed('comparison', lambda: comparison.test_comparison(browser))
    timed('kept settings', lambda: comparison.test_kept_settings(browser))
    timed('inspection', lambda: inspection.test_inspection(browser))
    timed('probe', lambda: inspection.test_probe(browser))
    timed('arrows', lambda: inspection.test_arrows(browser))
    timed('preview', lambda: inspection.test_preview(browser))
    timed('upload', lambda: sessions.test_upload(browser, folder))
    timed('list of scenes', lambda: sessions.test_open_scene(browser))
    timed('tabs', lambda: sessions.test_two_tabs(browser, address))
    timed('reconnection', lambda: sessions.test_reconnection(browser, relay))
    timed('phone', lambda: access.test_phone(browser))
    timed('names', lambda: access.test_names(browser))
    timed('contrast', lambda: access.test_contrast(browser))
    timed('jpeg', lambda: pictures.test_without_webcodecs(browser, address))
    timed('restart', lambda: sessions.test_restart(browser, server, relay))
    access.check_silence(browser, relay)


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
        server.start('--uploads', '1')
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

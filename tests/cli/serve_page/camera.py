"""Hands on the picture move the camera."""

import json
import time

from browser import check
from page import center, click_on

EYE = "['', '-y', '-z'].map(axis => document.getElementById('field-eye' + axis).valueAsNumber)"


def moved(browser, what, act):
    before = browser.evaluate(EYE)
    act()
    browser.wait(f"({EYE}).some((v, i) => Math.abs(v - {json.dumps(before)}[i]) > 1e-3)", what)


def wait_for(browser, eye, what):
    browser.wait(f"({EYE}).every((v, i) => Math.abs(v - {json.dumps(eye)}[i]) < 1e-3)", what)


def test_camera(browser):
    x, y = center(browser.evaluate('''(({left, top, width, height}) => ({left, top, width, height}))
        (document.getElementById('stage').getBoundingClientRect())'''))
    before = browser.evaluate(EYE)
    moved(browser, 'orbiting', lambda: browser.drag((x, y), (x + 60, y + 10)))
    browser.wait("document.getElementById('undo').title.includes('eye')", 'a movement as a step of undo')
    undone = browser.evaluate(EYE)
    click_on(browser, '#undo')
    wait_for(browser, before, 'the movement, undone')
    click_on(browser, '#redo')
    wait_for(browser, undone, 'the movement, done again')
    moved(browser, 'the wheel', lambda: browser.wheel(x, y, -200))
    moved(browser, 'flying', lambda: [browser.call('Input.dispatchKeyEvent', type='keyDown', key='w', code='KeyW'),
                                      time.sleep(0.2),
                                      browser.call('Input.dispatchKeyEvent', type='keyUp', key='w', code='KeyW')])
    target = browser.evaluate("document.getElementById('field-target').value")
    browser.click(x - 70, y - 30, count=2)
    browser.wait(f"document.getElementById('field-target').value !== '{target}'", 'a double click')
    # Steps end when the camera rests, or is moved back: from here the next one begins.
    click_on(browser, '#undo')
    click_on(browser, '#redo')
    here = browser.evaluate(EYE)
    for button in ('reset_camera', 'see_all', 'reset_camera'):
        moved(browser, button, lambda: click_on(browser, f'[data-request={button}]'))
        click_on(browser, '#undo')
        wait_for(browser, here, f'{button}, undone')
        click_on(browser, '#redo')
        moved_to = browser.wait(f"({EYE}).some((v, i) => Math.abs(v - {json.dumps(here)}[i]) > 1e-3) && {EYE}",
                                f'{button}, done again')
        here = moved_to
    wait_for(browser, before, 'the first camera')
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

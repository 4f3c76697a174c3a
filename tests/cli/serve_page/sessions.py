"""Files that are sent, other pages, lost connections, and a program that is started again."""

import pathlib
import time

from browser import check
from page import box_of, center, click_on, open_page, settle, type_into, value_of


def drop(browser, selector, *files):
    x, y = center(box_of(browser, selector))
    data = {'items': [], 'files': [str(file) for file in files], 'dragOperationsMask': 1}
    for kind in ('dragEnter', 'dragOver', 'drop'):
        browser.call('Input.dispatchDragEvent', type=kind, x=x, y=y, data=data)


def test_upload(browser, folder):
    """Scenes of this device, dropped on the picture and beside it. Undo does not go on into another scene."""
    for name, ending, selector, seed in (('dropped', 'obj', '#stage', 3), ('beside', 'OBJ', '#panel-head', 4)):
        type_into(browser, '#field-seed-number', str(seed))
        browser.wait("!document.getElementById('undo').disabled", f'{name}: a step of undo')
        file = pathlib.Path(folder) / f'{name}.{ending}'
        file.write_text('v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n')
        texture = pathlib.Path(folder) / f'{name}.png'
        texture.write_bytes(b'')
        drop(browser, selector, texture, file)
        said = "document.getElementById('page-message').textContent"
        browser.wait(f"{said}.includes('{file.name}') && {said}.includes('The other file was ignored')", 'both files')
        browser.wait(f"document.getElementById('scene-name').textContent.includes('{name}')", f'the scene {name}')
        check(browser.evaluate("document.getElementById('undo').disabled"), 'undo goes on into another scene')
        settle(browser, name)
        browser.evaluate("document.getElementById('dismiss').click()")  # what was opened, above the seed
        click_on(browser, '[data-key=seed] .reset')
        browser.wait("document.getElementById('field-seed-number').valueAsNumber === 0", 'the default seed')


def leave_window(browser):
    """To another tab and back."""
    here = browser.open_tab()
    browser.call('Page.bringToFront')
    browser.call('Page.close')
    browser.session = here
    browser.call('Page.bringToFront')


def test_open_scene(browser):
    """Enter and clicks open a scene, but keys on the way to another one do not, nor does leaving the list."""
    name = "document.getElementById('scene-name').textContent"
    select = "document.getElementById('open-scene')"
    before = browser.evaluate(name)

    def check_waiting(what):
        browser.wait("!document.getElementById('open-scene-waiting').hidden", f'{what}: the button that opens it')
        time.sleep(0.3)
        check(browser.evaluate(name) == before, f'{what} opens a scene')

    def index_of(scene):
        return browser.evaluate(f"[...{select}.options].findIndex(option => option.value === '{scene}')")

    click_on(browser, '#open-scene')
    time.sleep(0.3)  # until the list is open
    for key in index_of('builtin:lab-mirror') * ['ArrowDown']:
        browser.key(key)
    time.sleep(0.3)
    click_on(browser, '#search')
    check_waiting('leaving an open list')
    click_on(browser, '#open-scene-waiting')
    browser.wait("document.activeElement.id === 'open-scene'", 'the focus, which the button had')
    browser.wait(f"{name}.includes('lab-mirror')", 'the chosen scene')
    settle(browser, 'the chosen scene')
    before = browser.evaluate(name)
    browser.evaluate(f"{select}.focus()")
    cornell = index_of('builtin:cornell')
    for key in (cornell + 1) * ['ArrowDown'] + ['ArrowUp']:
        browser.key(key)
    at = browser.evaluate(f"{select}.selectedIndex")
    check(at == cornell, f'keys stop at {at} instead of {cornell}')
    check_waiting('a key')
    leave_window(browser)
    check_waiting('leaving the window')
    browser.evaluate(f"{select}.focus()")
    browser.key('Enter')
    browser.wait(f"{name} === 'cornell'", 'the first scene')
    check(browser.evaluate(f"{select}.selectedIndex") == 0, 'the list does not go back to its start')
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
    before = value_of(browser, 'exposure')
    browser.size(900, 600)  # messages above the slider leave room for it
    slider = box_of(browser, '#field-exposure')
    x, y = slider['left'] + 0.75 * slider['width'], slider['top'] + slider['height'] / 2
    browser.mouse('mousePressed', x, y, 1)
    held = value_of(browser, 'exposure')
    check(held != before, 'the slider is not held')
    browser.session = second
    now = "document.getElementById('field-exposure-number').valueAsNumber"
    browser.wait(f"Math.abs({now} - {held}) < 1e-3", 'the slider')
    type_into(browser, '#field-exposure-number', '-2')
    check(value_of(browser, 'exposure') == -2, 'what was typed is lost')
    browser.session = first
    time.sleep(0.5)
    check(value_of(browser, 'exposure') == held, f'a held slider jumps from {held} to {value_of(browser, "exposure")}')
    browser.mouse('mouseReleased', x, y, 0)
    browser.wait("document.getElementById('field-exposure-number').valueAsNumber === -2", 'the slider, let go')
    type_into(browser, '#field-exposure-number', str(before))
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
    browser.wait("document.getElementById('activity').textContent === 'finished'", 'the changed picture', 60)
    click_on(browser, '[data-key=seed] .reset')


def test_restart(browser, server, relay):
    """A program that is started again has another token: the page says where to go, which works."""
    server.stop()
    browser.wait("document.body.classList.contains('lost')", 'the page does not see that the program has ended')
    server.start()  # without --uploads
    browser.wait("document.getElementById('connection').textContent.includes('open the address that it prints')",
                 'the page does not say where to go')
    open_page(browser, relay.address())
    check(browser.evaluate("!document.body.classList.contains('lost')"), 'the new address does not work')
    drop(browser, '#panel-head', server.state)
    browser.wait("document.getElementById('page-message').textContent.includes('without --uploads')",
                 'the page does not say that no file is taken')

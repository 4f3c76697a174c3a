"""Images of passes instead of the picture, and motion as arrows."""

import time

from browser import check
from page import center, choose, click_on, evaluate, settle

PASS = 'svgf/variance diffuse'
INSPECTED = "document.getElementById('stage').dataset.inspected === 'true'"


def stage_center(browser):
    return center(browser.evaluate('''(({left, top, width, height}) => ({left, top, width, height}))
        (document.getElementById('stage').getBoundingClientRect())'''))


def click_on_pass(browser, name):
    browser.evaluate(f'''(() => {{
      const button = [...document.querySelectorAll('.passes button')].find(each => each.textContent === '{name}');
      button.id = 'this-pass';
    }})()''')
    click_on(browser, '#this-pass')
    browser.evaluate("document.getElementById('this-pass').removeAttribute('id')")


def find_history(browser, x, y):
    """Some pixels see a surface, whose history was kept, and others may not."""
    history = "document.getElementById('inspected-history').textContent"
    told = []
    for across in range(-160, 161, 40):
        for down in range(-100, 101, 50):
            browser.mouse('mouseMoved', x + across, y + down, 0)
            time.sleep(0.2)
            told.append(browser.evaluate(history))
            if 'history kept: ' in told[-1]:
                return
    check(False, f'no pixel has a history: {set(told)}')


def test_inspection(browser):
    """A click on a pass shows its images and the values under the mouse; another click shows the picture."""
    choose(browser, 'denoiser', 'svgf')
    browser.wait(f"[...document.querySelectorAll('.passes button')].some(b => b.textContent === '{PASS}')", 'the pass')
    settle(browser, 'the denoised picture')
    picture = evaluate(browser, 'window.before = await pixels(); return before.data.length;')
    click_on_pass(browser, PASS)
    browser.wait(INSPECTED, 'an image of the pass')
    settle(browser, 'the image of the pass')
    check(picture and evaluate(browser, 'return difference(before, await pixels()).mean;') > 3, 'it is the picture')
    images = browser.evaluate("[...document.getElementById('field-image').options].map(option => option.textContent)")
    name = browser.evaluate("document.getElementById('inspected-name').textContent")
    check(name == f'{PASS}: {images[0]}', f'the picture area says {name}')
    x, y = stage_center(browser)
    browser.mouse('mouseMoved', x, y, 0)
    values = "document.getElementById('inspected-values').textContent"
    first = browser.wait(f"{values}.startsWith('(') && {values}", 'the values under the mouse')
    check(': ' in first, f'the values are {first}')
    browser.mouse('mouseMoved', x + 40, y, 0)
    browser.wait(f"{values}.split(':')[0] !== '{first.split(':')[0]}'", 'the values of another pixel')
    find_history(browser, x, y)
    evaluate(browser, 'window.before = await pixels();')
    click_on(browser, '#field-view-false-color')
    browser.wait("document.getElementById('field-view-false-color').checked", 'the edit')
    time.sleep(0.3)
    settle(browser, 'false colours')
    check(evaluate(browser, 'return difference(before, await pixels()).mean;') > 3, 'false colours change nothing')
    legend = browser.evaluate("""[...document.querySelectorAll('.legend:not([hidden]) .values span')]
        .map(each => each.textContent)""")
    check(legend == ['0', '1 and more'], f'the legend of false colours says {legend}')
    click_on(browser, '[data-key="view.false_color"] .reset')
    choose(browser, 'pass', 'pathtrace')
    images = browser.wait('''(() => {
      const names = [...document.getElementById('field-image').options].map(option => option.textContent);
      return names.length > 2 && names;
    })()''', 'the images of another pass')
    choose(browser, 'image', images[1])
    browser.wait(f"document.getElementById('inspected-name').textContent === 'pathtrace: {images[1]}'", 'another image')
    click_on(browser, '#show-picture')
    browser.wait("document.getElementById('inspected').hidden", 'the click')
    browser.wait(f"!({INSPECTED})", 'the picture')
    click_on_pass(browser, PASS)
    browser.wait(INSPECTED, 'the pass, again')
    click_on_pass(browser, PASS)
    browser.wait(f"!({INSPECTED})", 'the picture, by a click on the pass')


def test_preview(browser):
    """The images of a pass are shown while the mouse rests on it; what a click has chosen comes back."""
    shown = "document.getElementById('inspected').hidden ? '' : document.getElementById('inspected-name').textContent"
    row = "[...document.querySelectorAll('.passes button')].find(each => each.textContent === '{}')"
    x, y = stage_center(browser)

    def rest_on(name):
        browser.evaluate(f"({row.format(name)}).scrollIntoView({{block: 'center'}})")
        browser.mouse('mouseMoved', *center(browser.evaluate(f"""(({{left, top, width, height}}) =>
            ({{left, top, width, height}}))(({row.format(name)}).getBoundingClientRect())""")), 0)

    time.sleep(1)  # a movement becomes a step of undo when the camera rests
    choose(browser, 'denoiser', 'svgf')
    step = browser.evaluate("document.getElementById('undo').title")
    browser.wait(f'Boolean({row.format(PASS)})', 'the pass')
    rest_on(PASS)
    browser.wait(f"({shown}).startsWith('{PASS}')", 'the pass under the mouse')
    rest_on('svgf/compose')
    browser.wait(f"({shown}).startsWith('svgf/compose')", 'the next pass under the mouse')
    browser.mouse('mouseMoved', x, y, 0)
    browser.wait(f"({shown}) === ''", 'the picture, as the mouse left')
    now = browser.evaluate("document.getElementById('undo').title")
    check(now == step, f'what is only shown for the mouse is a step of undo: {step} becomes {now}')
    click_on_pass(browser, PASS)
    browser.wait(f"({shown}).startsWith('{PASS}')", 'the chosen pass')
    rest_on('svgf/compose')
    browser.wait(f"({shown}).startsWith('svgf/compose')", 'the pass under the mouse, again')
    browser.mouse('mouseMoved', x, y, 0)
    browser.wait(f"({shown}).startsWith('{PASS}')", 'the chosen pass, again')
    click_on(browser, '#undo')
    browser.wait(f"({shown}) === ''", 'the choice, undone')
    click_on(browser, '#redo')
    browser.wait(f"({shown}).startsWith('{PASS}')", 'the choice, done again')
    click_on(browser, '#show-picture')
    browser.wait(f"!({INSPECTED})", 'the picture')


def test_probe(browser):
    """P reads the pixel under the mouse, and marks it; elsewhere it reads another, and again it hides the values."""
    values = "document.getElementById('values').hidden ? '' : document.getElementById('values').textContent"
    cross = "document.getElementById('picture').dataset.probe"
    x, y = stage_center(browser)
    browser.mouse('mouseMoved', x, y, 0)
    browser.key('p')
    first = browser.wait(f"({values}).startsWith('pixel (') && ({values})", 'the values of the pixel')
    browser.wait(f"{cross}.split(',').every(each => Math.abs(each - 0.5) < 0.02) && {cross}", 'the cross')
    browser.mouse('mouseMoved', x + 60, y, 0)
    browser.key('p')
    browser.wait(f"({values}).startsWith('pixel (') && ({values}).split(')')[0] !== '{first.split(')')[0]}'", 'others')
    browser.key('p')
    browser.wait(f"({values}) === '' && {cross} === ''", 'no values')


def test_arrows(browser):
    """What the camera moves has arrows; a method without motion says so."""
    arrows = "Number(document.getElementById('picture').dataset.arrows)"
    click_on(browser, '#field-arrows')
    x, y = stage_center(browser)
    browser.mouse('mouseMoved', x, y, 0)
    browser.mouse('mousePressed', x, y, 1)
    most = 0
    for step in range(1, 60):
        browser.mouse('mouseMoved', x + 3 * step, y + step, 1)
        time.sleep(0.05)
        most = max(most, browser.evaluate(arrows))
        if most > 5:
            break
    browser.mouse('mouseReleased', x, y, 0)
    check(most > 5, f'there are {most} arrows')
    settle(browser, 'the picture at rest')
    browser.wait(f'{arrows} === 0', 'what rests has no arrows')
    check(browser.evaluate("document.getElementById('no-motion').hidden"), 'svgf has no motion')
    choose(browser, 'denoiser', 'none')
    browser.wait("!document.getElementById('no-motion').hidden", 'the note that there is no motion')
    click_on(browser, '#field-arrows')
    browser.wait("document.getElementById('no-motion').hidden", 'the end of the note')
    click_on(browser, '[data-request=reset_camera]')
    settle(browser, 'the path tracer')

"""The panel: values, their defaults, undo, the search, presets."""

from browser import check
from page import choose, click_on, settle, type_into, value_of


def test_controls(browser):
    marked = browser.evaluate("[...document.querySelectorAll('.field.changed')].map(f => f.dataset.key).join()")
    check(marked == 'max_samples', f'marked as changed, but by nobody: {marked}')
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
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 0", 'undo after redo')
    browser.key('y', 2)
    browser.wait("document.getElementById('field-seed-number').valueAsNumber === 7", 'redo by Ctrl+Y')
    browser.key('z', 2)
    type_into(browser, '#field-seed-number', '1234567')
    check(value_of(browser, 'seed') == 1234567, f'a long number becomes {value_of(browser, "seed")}')
    click_on(browser, '[data-key=seed] .reset')


def test_steps(browser):
    """Undo, of a store of its own: how many steps there are, what one is, and which go with the scene."""
    steps = browser.evaluate('''(async () => {
      const {Store} = await import('/store.js'), {rememberMovements} = await import('/movements.js');
      const store = new Store(() => 1), movements = rememberMovements(store), counts = {};
      const rest = () => new Promise(done => setTimeout(done, 1000));
      const count = () => {
        let steps = 0;
        for (; store.undoes() !== undefined; ++steps) store.undo();
        return steps;
      };
      store.receiveState({a: 0, lights: [0], background: [1, 1, 1], eye: [0, 0, 0]}, 0);
      for (let i = 1; i <= 250; ++i) store.edit({a: i});
      counts.most = count();
      store.hold('a', true);
      store.edit({a: 1001});
      await rest();
      store.edit({a: 1002});
      store.hold('a', false);
      await rest();
      store.hold('a', true);
      store.edit({a: 1003});
      store.hold('a', false);
      counts.drags = count();
      store.edit({a: 1004});
      store.edit({lights: [1]});
      store.receiveState({lights: [0, 0]}, 0);
      counts.lights = count();
      store.receiveFacts({scene: 'one'});
      store.edit({a: 1005});
      store.receiveFacts({scene: 'two'});
      counts.scene = count();
      movements.begin(7);
      await rest(); // a slow frame
      store.acknowledge(7, 1);
      store.receiveState({eye: [1, 1, 1]}, 1);
      await rest();
      counts.movements = count();
      store.edit({background: null});
      counts.background = store.value('background');
      return counts;
    })()''')
    expected = {'most': 200, 'drags': 2, 'lights': 1, 'scene': 0, 'movements': 1, 'background': None}
    check(steps == expected, f'steps of undo: {steps}')


def test_colors(browser):
    """The browser's chooser is no part of the page: all that is chosen in it is one step, and it does not jump."""
    color = "document.getElementById('light-0-color').value"
    before = browser.evaluate(color)
    browser.evaluate('''(() => {
      const input = document.getElementById('light-0-color');
      for (const color of ['#ff8080', '#804040', '#802020']) {
        input.value = color;
        input.dispatchEvent(new Event('input'));
      }
    })()''')
    check(browser.evaluate(color) == '#802020', 'the chooser jumps to the brightest colour of this hue')
    browser.evaluate("document.getElementById('light-0-color').dispatchEvent(new Event('change'))")
    browser.wait(f"{color} !== '#802020'", 'the colour at its brightest')
    click_on(browser, '#undo')
    browser.wait(f"{color} === '{before}'", 'the colour, undone')
    settle(browser, 'the light as it was')


def test_lights(browser):
    """What is open stays open when another light is added, which stands before it, or removed."""
    opened = "JSON.stringify([...document.querySelectorAll('.light details')].map(details => details.open))"
    browser.evaluate("document.querySelector('.light details').open = true")
    click_on(browser, '[data-request=add_sun]')
    browser.wait(f"{opened} === '[false,true]'", 'the open light, with a new one')
    click_on(browser, '.light button[aria-label^=remove]')
    browser.wait(f"{opened} === '[true]'", 'the open light, alone')
    browser.evaluate("document.querySelector('.light details').open = false")
    settle(browser, 'the light as it was')


def test_method_before_preview(browser):
    """The key V goes back to it, however the preview was chosen, and so does undo."""
    denoiser = "document.getElementById('field-denoiser').selectedOptions[0].textContent"
    choose(browser, 'denoiser', 'atrous')
    settle(browser, 'the denoised picture')
    for go_back in (lambda: browser.type('v'), lambda: click_on(browser, '#undo')):
        choose(browser, 'integrator', 'preview')
        browser.wait(f"{denoiser} === 'none'", 'the preview')
        browser.evaluate("document.getElementById('stage').focus()")
        go_back()
        browser.wait(f"{denoiser} === 'atrous'", 'the method before the preview')
        settle(browser, 'the denoised picture, again')
        check(browser.evaluate(denoiser) == 'atrous', 'the method before the preview does not stay')
    choose(browser, 'denoiser', 'none')
    settle(browser, 'the path tracer')


def test_search(browser):
    click_on(browser, '#search')
    browser.type('exposure')
    shown = browser.evaluate('''[...document.querySelectorAll('.field[data-key]')]
        .filter(f => f.offsetParent).map(f => f.dataset.key)''')
    check('exposure' in shown and 'seed' not in shown and len(shown) < 10, f'found: {shown}')
    found = browser.evaluate("document.getElementById('search-result').textContent")
    everything = "[...document.querySelectorAll('#panel .body > *')].filter(e => e.offsetParent).length"
    check(found == f'{browser.evaluate(everything)} found', f'it says {found}')
    for words, place in (('automatic camera', '[data-request=see_all]'), ('firefly', '[data-key="svgf.fireflies"]'),
                         ('passes images', '.passes')):
        browser.evaluate("document.getElementById('search').value = ''")
        browser.type(words)
        visible = browser.evaluate(f"Boolean(document.querySelector('{place}').offsetParent)")
        check(visible, f'"{words}" does not find {place}')
        check(not browser.evaluate("document.querySelector('[data-key=seed]').offsetParent"), 'it finds the seed')
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


def test_presets(browser):
    """One sets method and parameters; one step of undo takes it back."""
    value = "document.getElementById('field-{}').{}"
    chosen = "document.getElementById('preset').selectedOptions[0].textContent"
    check(browser.evaluate(chosen) == 'none', 'a preset is in force at first')
    flags = f"[{value.format('temporal-grey-restart', 'checked')}, {value.format('temporal-demodulate', 'checked')}]"
    check(browser.evaluate(flags) == [False, True], 'the defaults')
    browser.evaluate('''(() => {
      const select = document.getElementById('preset');
      select.selectedIndex = [...select.options].findIndex(option => option.textContent === 'history-tracking-course');
      select.dispatchEvent(new Event('change'));
    })()''')
    browser.wait(f"{value.format('denoiser', 'selectedOptions[0].textContent')} === 'atrous'", 'the denoiser')
    settle(browser, 'the picture of the preset')
    check(browser.evaluate(flags) == [True, False], 'parameters of the preset')
    check(browser.evaluate(chosen) == 'history-tracking-course', 'the list does not show the preset')
    check('History tracking' in browser.evaluate("document.getElementById('preset-help').textContent"), 'no source')
    check('history-tracking-course' in browser.evaluate("document.getElementById('undo').title"), 'undo has no name')
    type_into(browser, '#field-atrous-levels-number', '3')
    browser.wait(f"{chosen} === 'none'", 'a changed preset')
    click_on(browser, '#undo')
    browser.wait(f"{chosen} === 'history-tracking-course'", 'the preset again')
    click_on(browser, '#undo')
    browser.wait(f"{value.format('denoiser', 'selectedOptions[0].textContent')} === 'none'", 'undo')
    check(browser.evaluate(flags) == [False, True], 'undo of parameters')
    settle(browser, 'the path tracer')


def test_parts(browser):
    """Only switches for parts that the chosen denoiser has."""
    shown = """['temporal', 'spatial', 'demodulation'].filter(name => {
      const row = document.querySelector(`[data-key="part.${name}"]`);
      row.closest('details').open = true;
      return row.offsetParent !== null;
    }).join()"""
    for denoiser, parts in (('temporal', 'temporal,demodulation'), ('bilateral', 'spatial,demodulation'),
                            ('atrous', 'temporal,spatial,demodulation'), ('nano', 'temporal,spatial,demodulation'),
                            ('none', '')):
        choose(browser, 'denoiser', denoiser)
        browser.wait(f"{shown} === '{parts}'", f'the parts of {denoiser}')
    settle(browser, 'the path tracer')


def test_messages(browser):
    """Errors and messages can be hidden; the next one is shown again. The command line has its own place."""
    fault = "document.getElementById('fault').textContent"
    cross = "getComputedStyle(document.getElementById('dismiss')).display !== 'none'"
    check(not browser.evaluate(cross), 'there is a cross without a message')
    click_on(browser, '#command-line')
    browser.wait("document.getElementById('command').textContent.startsWith('limpid render')", 'the command line')
    message = browser.evaluate("document.getElementById('message').textContent")
    check('limpid render' not in message, f'the command line is a message, too: {message}')
    for name in ('broken.glb', 'torn.glb'):
        browser.evaluate(f"fetch('/upload' + location.search + '&name={name}', {{method: 'POST', body: 'x'}})")
        browser.wait(f"{fault}.includes('{name}')", 'the error')
        click_on(browser, '#dismiss')
        browser.wait(f"{fault} === ''", 'the end of the error')
        check(not browser.evaluate(cross), 'the cross stays')

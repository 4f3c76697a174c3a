"""Phones, names, contrast, and what the page asks others for."""

import urllib.request

from browser import check
from camera import moved
from page import click_on, settle

PHONE = (390, 844)


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

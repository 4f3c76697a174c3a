"""Two pictures, and the line between them."""

from browser import check
from page import box_of, center, choose, click_on, evaluate, settle


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


def test_kept_settings(browser):
    """To keep the settings is a step of undo."""
    compared = "document.getElementById('field-compare').selectedOptions[0].textContent"
    click_on(browser, '[data-request=keep_settings]')
    browser.wait(f"{compared} === 'kept settings'", 'the kept settings')
    browser.wait("document.getElementById('undo').title.startsWith('Undo: keep these settings')", 'the step')
    click_on(browser, '#undo')
    browser.wait(f"{compared} === 'nothing'", 'the step, undone')
    browser.wait("document.getElementById('divider').hidden", 'the end of the comparison')

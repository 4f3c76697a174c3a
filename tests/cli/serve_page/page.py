"""What the page shows, and hands on its controls."""

import json
import re


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
                 "document.querySelector('#activity').textContent.match(/finished|stopped/)", what, 60)


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

// Looking at a page from outside: what is in a canvas, what a read-out says.

/// Little-endian floats, decoded by Node and not by the page.
export function decode(base64) {
  const bytes = Buffer.from(base64, 'base64');
  return Array.from({ length: bytes.length / 4 }, (_, k) => bytes.readFloatLE(4 * k));
}

/// How many different colours a canvas (flat or WebGL) shows, in a small copy.
export const coloursOf = (canvas) => canvas.evaluate((source) => {
  const copy = Object.assign(document.createElement('canvas'), { width: 200, height: 200 });
  const context = copy.getContext('2d');
  context.drawImage(source, 0, 0, 200, 200);
  const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  return new Set(pixels).size;
});

export async function started(page, stage) {
  await page.waitForFunction((element) => element.dataset.started, stage, { timeout: 30000 });
  await page.waitForTimeout(200);
}

/// Puts the pointer on direction (x, y) of the first map; gives the read-out, and how green the picture
/// is there and at (x, −y).
export async function hover(page, x, y) {
  const frame = await page.$('.disc');
  await frame.scrollIntoViewIfNeeded();
  const place = await frame.evaluate((element, [u, v]) => {
    const rim = element.querySelector('.rim').getBoundingClientRect();
    const canvas = element.querySelector('canvas');
    const box = canvas.getBoundingClientRect();
    const at = (dx, dy) => [rim.left + rim.width * (dx + 1) / 2, rim.top + rim.height * (1 - dy) / 2];
    const green = ([px, py]) => canvas.getContext('2d').getImageData(Math.round((px - box.left) * canvas.width / box.width),
      Math.round((py - box.top) * canvas.height / box.height), 1, 1).data[1];
    return { at: at(u, v), green: { here: green(at(u, v)), mirrored: green(at(u, -v)) } };
  }, [x, y]);
  await page.mouse.move(...place.at);
  return {
    angles: await page.textContent('[data-component=direction_maps] .probe'),
    value: await page.textContent('[data-component=direction_maps] .tile .readout'),
    green: place.green,
  };
}

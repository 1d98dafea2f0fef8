// Pictures of each mode of the console, at each size and in both themes, to be looked at: script/screenshots FOLDER. Says where
// something sticks out of the window or a page with a robot has no Stop in sight.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { labCopy, launch, open, serveRobotAt } from './browser.mjs';
import { isIdle, until } from './robot_page.mjs';

const folder = process.argv[2];
if (!folder) throw new Error('found no folder for the pictures, wanted one');
mkdirSync(folder, { recursive: true });

const sizes = [['desk', 1280, 800, 1], ['phone', 390, 844, 1], ['wall', 3840, 2160, 1], ['zoomed', 640, 400, 2]];
const modes = ['edit', 'hang', 'places', 'map', 'live', 'replay'];
const complaints = [];

const robot = await serveRobotAt(labCopy());
const browser = await launch();
try {
  for (const [name, width, height, deviceScaleFactor] of sizes) {
    for (const colorScheme of ['light', 'dark']) {
      const page = await open(browser, robot.url, { width, height }, { colorScheme, deviceScaleFactor });
      await until(page, isIdle);
      for (const mode of modes) {
        const title = `${mode}-${name}-${colorScheme}`;
        await page.evaluate((m) => window.lodestar.console.modes.enter(m), mode);
        await page.waitForTimeout(700);
        await page.screenshot({ path: join(folder, `${title}.png`) });
        const { wide, stop } = await page.evaluate(() => {
          const box = document.getElementById('live-stop').getBoundingClientRect();
          return { wide: document.documentElement.scrollWidth - innerWidth, stop: box.width > 0 && box.left >= 0 && box.right <= innerWidth && box.top >= 0 && box.bottom <= innerHeight };
        });
        if (wide > 0) complaints.push(`${title}: ${wide} pixels wider than the window`);
        if (!stop) complaints.push(`${title}: no Stop in sight`);
      }
      complaints.push(...page.complaints.map((words) => `${name} ${colorScheme}: ${words}`));
      await page.context().close();
    }
  }
} finally {
  await browser.close();
  await robot.stop();
}
for (const words of complaints) console.error(words);
console.log(`${sizes.length * 2 * modes.length} pictures in ${folder}`);
process.exitCode = complaints.length === 0 ? 0 : 1;

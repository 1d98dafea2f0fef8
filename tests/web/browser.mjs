// A browser that looks at the console.
import { readFileSync } from 'node:fs';
import { packages } from './programs.mjs';

export { labCopy, serve, serveRobot, serveRobotAt, serveSite, withOutline } from './programs.mjs';

const { chromium } = packages('playwright-core');
export const axeSource = readFileSync(packages.resolve('axe-core/axe.min.js'), 'utf8');

const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];

export const launch = () => chromium.launch({ executablePath: '/usr/bin/chromium', headless: true, args: flags });

/** LODESTAR_WINDOW=390x844 walks through a test at another size. */
const [width, height] = (process.env.LODESTAR_WINDOW ?? '1280x800').split('x').map(Number);

/** A page that has loaded, in a window of this size. */
export async function open(browser, url, size = { width, height }, more = {}) {
  const context = await browser.newContext({ viewport: size, ...more });
  const page = await context.newPage();
  page.complaints = [];
  page.on('pageerror', (error) => page.complaints.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error' && !/status of 4(12|01|22)/.test(message.text())) page.complaints.push(message.text());
  });
  await page.goto(url);
  await page.waitForFunction(() => window.lodestar !== undefined, undefined, { polling: 100 });
  return page;
}

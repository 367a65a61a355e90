// SPDX-License-Identifier: BSD-3-Clause
// What pages weigh and how fast they are: node test/measure.mjs PAGE.html ... Medians of five openings, each in a new tab.
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { launch } from "./chromium.mjs";

const TIMES = 5;
const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
const browser = await launch();
console.log("page                                MB   first frame [ms]   a seek [ms]");
for (const name of process.argv.slice(2)) {
  const frames = [], seeks = [];
  for (let i = 0; i < TIMES; ++i) {
    const page = await browser.newPage();
    await page.setViewport({ width: 1280, height: 800 });
    const begin = Date.now();
    await page.goto(`file://${resolve(name)}`);
    await page.waitForSelector("body.ready", { timeout: 60000 });
    const drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    await page.evaluate(drawn);
    frames.push(Date.now() - begin);
    const sought = Date.now();
    await page.evaluate(() => replay.seek(replay.begin + 0.6 * (replay.end - replay.begin)));
    await page.evaluate(drawn);
    seeks.push(Date.now() - sought);
    await page.close();
  }
  console.log(`${name.padEnd(33)} ${(statSync(name).size / 1e6).toFixed(2).padStart(5)} ${median(frames).toFixed(0).padStart(18)} ${median(seeks).toFixed(0).padStart(13)}`);
}
await browser.close();

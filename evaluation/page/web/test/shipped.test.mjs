// SPDX-License-Identifier: BSD-3-Clause
// The page that is shipped, docs/playground.html: TOUCHDOWN_SHIPPED names it. What it can do is tested where it is made
// (playground.test.mjs); here, that it opens and plans.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch } from "./chromium.mjs";

const file = process.env.TOUCHDOWN_SHIPPED;
let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

test("the shipped planner page opens from the disk and plans", async () => {
  assert.ok(statSync(file).size <= 2e6);
  const page = await browser.newPage();
  const said = [];
  page.on("pageerror", (error) => said.push(error.message));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || said.push(request.url()));
  await page.goto(`file://${file}`);
  await page.waitForSelector("body.ready", { timeout: 60000 });
  assert.equal(await page.evaluate(() => touchdown.answer.status), "planned");
  assert.equal(await page.evaluate(() => touchdown.answer.passed), true);
  assert.deepEqual(said, []);
});

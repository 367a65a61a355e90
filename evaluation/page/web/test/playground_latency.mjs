// SPDX-License-Identifier: BSD-3-Clause
// What a step costs in the page and in the program, as a table: node playground_latency.mjs PAGE.html ASK.mjs FROM TO PROGRAM...
// ASK.mjs: evaluation/playground/test/module.mjs, which starts programs.
// The scenes are the random ones with the seeds FROM to TO. Each is asked 100 times a go, by turns, three goes: the least counts.
import { resolve } from "node:path";
import { launch } from "./chromium.mjs";

const [file, asker, from, to, ...programs] = process.argv.slice(2);
const STEPS = 100, GOES = 3;

const { startProgram } = await import(resolve(asker));
const browser = await launch();
const page = await browser.newPage();
await page.goto(`file://${file}`);
await page.waitForSelector("body.ready", { timeout: 60000 });
const inPage = { name: "page", ask: (question) => page.evaluate((q) => touchdown.ask(q), question), end: () => browser.close() };
const who = [inPage, ...programs.map((path) => ({ name: path, ...startProgram(path) }))];

const quantile = (values, q) => values[Math.min(values.length - 1, Math.floor(q * values.length))];
console.log("| backend | where | median [ms] | p95 [ms] | largest [ms] | over the first program: median | largest |");
console.log("|---|---|---|---|---|---|---|");
for (const backend of ["banded", "lbfgs"]) {
  const least = who.map(() => []);
  for (let seed = Number(from); seed <= Number(to); ++seed) {
    const scene = { ...(await inPage.ask({ do: "random", seed })), backend };
    const best = who.map(() => Infinity);
    for (let go = 0; go < GOES; ++go) {
      for (const [i, one] of who.entries()) {
        best[i] = Math.min(best[i], (await one.ask({ do: "time", scene, steps: STEPS })).mean_ms);
      }
    }
    best.forEach((ms, i) => least[i].push(ms));
  }
  for (const [i, one] of who.entries()) {
    const sorted = [...least[i]].sort((a, b) => a - b);
    const ratios = least[i].map((ms, k) => ms / least[1][k]).sort((a, b) => a - b);
    const cells = [quantile(sorted, 0.5), quantile(sorted, 0.95), sorted.at(-1), quantile(ratios, 0.5), ratios.at(-1)].map((x) => x.toFixed(2));
    console.log(`| ${backend} | ${one.name} | ${cells.join(" | ")} |`);
  }
}
who.forEach((one) => one.end());

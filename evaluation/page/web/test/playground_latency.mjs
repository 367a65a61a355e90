// SPDX-License-Identifier: BSD-3-Clause
// What a step costs in the page and in the program, as a table: node playground_latency.mjs PAGE.html FROM TO PROGRAM...
// The scenes are the random ones with the seeds FROM to TO. Each is asked 100 times a go, by turns, three goes: the least counts.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { launch } from "./chromium.mjs";

const [file, from, to, ...programs] = process.argv.slice(2);
const STEPS = 100, GOES = 3;

function startProgram(path) {
  const child = spawn(path, { stdio: ["pipe", "pipe", "inherit"] });
  const waiting = [];
  createInterface({ input: child.stdout }).on("line", (line) => waiting.shift()(JSON.parse(line)));
  const ask = (question) => new Promise((done) => (waiting.push(done), child.stdin.write(`${JSON.stringify(question)}\n`)));
  return { name: path, ask, end: () => child.stdin.end() };
}

const browser = await launch();
const page = await browser.newPage();
await page.goto(`file://${file}`);
await page.waitForSelector("body.ready", { timeout: 60000 });
const inPage = { name: "page", ask: (question) => page.evaluate((q) => touchdown.ask(q), question), end: () => browser.close() };
const who = [inPage, ...programs.map(startProgram)];

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

// SPDX-License-Identifier: BSD-3-Clause
// Puts the planner in a page together, one file: node playground.mjs MODULE.js MODULE.wasm OUT.html
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { bundle, guarded, licencesOf } from "./bundle.mjs";

const [glue, wasm, out] = process.argv.slice(2);
if (!out) {
  console.error("node playground.mjs MODULE.js MODULE.wasm OUT.html");
  process.exit(2);
}
const folder = join(dirname(fileURLToPath(import.meta.url)), "src/playground");
const text = (name) => readFileSync(join(folder, name), "utf8");
const { script } = await bundle("src/playground/main.js");
const parts = {
  "/*style*/": text("playground.css"),
  "/*script*/": script,
  "/*glue*/": guarded(readFileSync(glue, "utf8")),
  "<!--module-->": gzipSync(readFileSync(wasm), { level: 9 }).toString("base64"),
  "<!--licences-->": licencesOf(["three"]),
};
let page = text("playground.html");
for (const [place, part] of Object.entries(parts)) page = page.replace(place, () => part);
writeFileSync(out, page);

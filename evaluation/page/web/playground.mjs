// SPDX-License-Identifier: BSD-3-Clause
// Puts the planner in a page together, one file: node playground.mjs MODULE.js MODULE.wasm OUT.html
// Without a module it prints the mark of the web sources that such a page bears.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { bundle, guarded, licencesOf } from "./bundle.mjs";

const [glue, wasm, out] = process.argv.slice(2);
if (glue && !out) {
  console.error("node playground.mjs [MODULE.js MODULE.wasm OUT.html]");
  process.exit(2);
}
const folder = join(dirname(fileURLToPath(import.meta.url)), "src/playground");
const text = (name) => readFileSync(join(folder, name), "utf8");
const { script, style: signs } = await bundle("src/playground/main.js");
const style = signs + text("playground.css"), html = text("playground.html");
const mark = `<!--web sources ${createHash("sha256").update(JSON.stringify([script, style, html])).digest("hex")}-->`;
if (!out) {
  console.log(mark);
  process.exit();
}
const parts = {
  "<!--mark-->": mark,
  "/*style*/": style,
  "/*script*/": script,
  "/*glue*/": guarded(readFileSync(glue, "utf8")),
  "<!--module-->": gzipSync(readFileSync(wasm), { level: 9 }).toString("base64"),
  "<!--licences-->": licencesOf(["three"]),
};
let page = html;
for (const [place, part] of Object.entries(parts)) page = page.replace(place, () => part);
writeFileSync(out, page);

// SPDX-License-Identifier: BSD-3-Clause
// Makes the parts of the page that are committed: node build.mjs [FOLDER]. The same bytes from the same lock file.
import { build } from "esbuild";
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, "../../data/replay");
mkdirSync(folder, { recursive: true });

const result = await build({
  absWorkingDir: here,
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["es2022"],
  legalComments: "none",
  outdir: folder,
  write: false,
});
const part = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending)).text;
// A page is found damaged by its end; nothing in the script may end it before.
writeFileSync(join(folder, "replay.js"), part(".js").replaceAll("</script", "<\\/script"));
writeFileSync(join(folder, "replay.css"), part(".css") + readFileSync(join(here, "src/page.css"), "utf8"));
copyFileSync(join(here, "src/page.html"), join(folder, "replay.html"));
const licences = ["three", "uplot"].map((name) => {
  const { version } = JSON.parse(readFileSync(join(here, "node_modules", name, "package.json"), "utf8"));
  return `${name} ${version}\n\n${readFileSync(join(here, "node_modules", name, "LICENSE"), "utf8").trim()}\n`;
});
writeFileSync(join(folder, "LICENCES.txt"), licences.join("\n"));

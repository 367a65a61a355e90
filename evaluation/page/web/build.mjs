// SPDX-License-Identifier: BSD-3-Clause
// Makes the parts of the replay page that are committed: node build.mjs [FOLDER].
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { bundle, licencesOf } from "./bundle.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, "../../data/replay");
mkdirSync(folder, { recursive: true });

const { script, style } = await bundle("src/main.js");
writeFileSync(join(folder, "replay.js"), script);
writeFileSync(join(folder, "replay.css"), style + readFileSync(join(here, "src/page.css"), "utf8"));
copyFileSync(join(here, "src/page.html"), join(folder, "replay.html"));
writeFileSync(join(folder, "LICENCES.txt"), licencesOf(["three", "uplot"]));

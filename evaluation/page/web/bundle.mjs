// SPDX-License-Identifier: BSD-3-Clause
// What pages are made of: their scripts in one text, and the licences of what is in it.
import { build } from "esbuild";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));

/** A page is found damaged by its end; nothing in a script may end it before. */
export const guarded = (script) => script.replaceAll("</script", "<\\/script");

/** { script, style } of an entry; the style is that of its packages. The same bytes from the same lock file. */
export async function bundle(entry) {
  const result = await build({
    absWorkingDir: here,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: "iife",
    target: ["es2022"],
    legalComments: "none",
    outdir: "built",
    write: false,
  });
  const part = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending))?.text ?? "";
  return { script: guarded(part(".js")), style: part(".css") };
}

export function licencesOf(names) {
  const one = (name) => {
    const { version } = JSON.parse(readFileSync(join(here, "node_modules", name, "package.json"), "utf8"));
    return `${name} ${version}\n\n${readFileSync(join(here, "node_modules", name, "LICENSE"), "utf8").trim()}\n`;
  };
  return names.map(one).join("\n");
}

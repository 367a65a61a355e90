// SPDX-License-Identifier: BSD-3-Clause
// rerun.mjs F.mcap F.png SECONDS: an export in Rerun's web viewer, in a Chromium without a window, at that time of the flight. Beside
// the lock file it needs: npm install --no-save @rerun-io/web-viewer@0.33.0 puppeteer-core@24.43.1
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { setTimeout } from "node:timers/promises";
import puppeteer from "puppeteer-core";

const [, , mcap, picture, at] = process.argv;
const WIDTH = 1240, HEIGHT = 980;
const LOADING = 70_000, DRAWING = 8_000; // [ms]: it draws in software
const PACKAGE = "node_modules/@rerun-io/web-viewer";
const PAGE = `<!doctype html><body style="margin:0"><script type="module">
import { WebViewer } from "/index.js";
const viewer = (window.viewer = new WebViewer());
viewer.on("recording_open", (event) => (window.recording = event.recording_id));
await viewer.start(location.origin + "/flight.mcap", document.body, { width: "${WIDTH}px", height: "${HEIGHT}px", hide_welcome_screen: true, render_backend: "webgl", theme: "light" });
for (const panel of ["selection", "blueprint"]) viewer.override_panel_state(panel, "hidden");
viewer.override_panel_state("time", "collapsed");
</script>`;
const TYPES = { html: "text/html", js: "text/javascript", wasm: "application/wasm", mcap: "application/octet-stream" };

const server = createServer((request, response) => {
  let name = request.url.slice(1) || "page.html";
  if (!name.includes(".")) name += ".js";
  const file = name === "flight.mcap" ? mcap : `${PACKAGE}/${name}`;
  const body = name === "page.html" ? PAGE : existsSync(file) ? readFileSync(file) : null;
  response.writeHead(body === null ? 404 : 200, { "content-type": TYPES[name.split(".").pop()] ?? "text/plain" }).end(body ?? "");
}).listen(0, "127.0.0.1");
const browser = await puppeteer.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
const tab = await browser.newPage();
await tab.setViewport({ width: WIDTH, height: HEIGHT });
await tab.goto(`http://127.0.0.1:${server.address().port}/`);
await setTimeout(LOADING);
await tab.evaluate((time) => {
  const { viewer, recording } = window;
  viewer.set_playing(recording, false);
  viewer.set_current_time(recording, viewer.get_active_timeline(recording), time);
}, 1e9 * Number(at));
await setTimeout(DRAWING);
await tab.screenshot({ path: picture });
await browser.close();
server.close();

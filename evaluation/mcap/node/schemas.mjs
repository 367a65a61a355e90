// SPDX-License-Identifier: BSD-3-Clause
// schemas.mjs OURS OUT: a FileDescriptorSet of every schema that an export can have, with all that it needs, by protoc. Foxglove's are
// generated as their package does it; ours are in OURS.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } from "@foxglove/schemas/internal.js";

const FOXGLOVE = ["CameraCalibration", "CompressedImage", "FrameTransforms", "Log", "PointCloud", "PoseInFrame", "PosesInFrame", "RawImage", "SceneUpdate"];
const [, , ours, out] = process.argv;

const work = mkdtempSync(join(tmpdir(), "schemas-"));
mkdirSync(join(work, "foxglove"));
for (const message of Object.values(foxgloveMessageSchemas)) {
  const enums = Object.values(foxgloveEnumSchemas).filter((one) => one.parentSchemaName === message.name);
  writeFileSync(join(work, "foxglove", `${message.name}.proto`), generateProto(message, enums));
}
mkdirSync(out, { recursive: true });
const make = (folder, name) =>
  execFileSync("protoc", [`-I${work}`, `-I${ours}`, "--include_imports", `--descriptor_set_out=${join(out, `${folder}.${name}.binpb`)}`, `${folder}/${name}.proto`]);
for (const name of FOXGLOVE) make("foxglove", name);
for (const file of readdirSync(join(ours, "touchdown"))) make("touchdown", file.replace(".proto", ""));
rmSync(work, { recursive: true });

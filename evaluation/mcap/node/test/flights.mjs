// SPDX-License-Identifier: BSD-3-Clause
// Flights, their records and their exports, for the tests.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor.js";

const PROGRAM = process.env.TOUCHDOWN_PROGRAM;
const OPTIONS = { stdio: "pipe", cwd: process.env.TOUCHDOWN_SOURCE };
export const FOLDER = mkdtempSync(join(tmpdir(), "mcap-"));

// A flight may end in any way: its status is not asked.
export function fly(name, ...words) {
  const record = join(FOLDER, `${name}.db`);
  try {
    execFileSync(PROGRAM, ["fly", ...words, "--record", record], OPTIONS);
  } catch (error) {
    if (error.status !== 1) throw error;
  }
  return record;
}

export function exported(record, name) {
  const file = join(FOLDER, `${name}.mcap`);
  execFileSync(PROGRAM, ["export", record, "--mcap", file], OPTIONS);
  return readFileSync(file);
}

const QUERY = `import json, sqlite3, sys
db = sqlite3.connect(sys.argv[1])
db.row_factory = sqlite3.Row
print(json.dumps([dict(row) for row in db.execute(sys.argv[2])]))`;

// Rows of a record.
export const rows = (record, sql) => JSON.parse(execFileSync("/usr/bin/python3", ["-c", QUERY, record, sql], { maxBuffer: 1 << 28 }));

const readable = (bytes) => ({ size: async () => BigInt(bytes.length), read: async (from, length) => bytes.subarray(Number(from), Number(from + length)) });

export const indexed = (bytes) => McapIndexedReader.Initialize({ readable: readable(bytes) });

// All records in the order of the file; checksums are looked at.
export function streamed(bytes) {
  const reader = new McapStreamReader();
  reader.append(bytes);
  const records = [];
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) records.push(record);
  if (!reader.done()) throw new Error("the file does not end");
  return records;
}

// Messages of each topic, decoded by what the file itself says of them: { t, ...fields }.
export async function topics(bytes) {
  const reader = await indexed(bytes);
  const types = new Map();
  for (const schema of reader.schemasById.values()) {
    types.set(schema.id, protobuf.Root.fromDescriptor(schema.data).resolveAll().lookupType(schema.name));
  }
  const found = new Map();
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const type = types.get(channel.schemaId);
    const content = type.toObject(type.decode(message.data), { defaults: true, arrays: true, longs: Number, enums: String });
    if (!found.has(channel.topic)) found.set(channel.topic, []);
    found.get(channel.topic).push({ logTime: message.logTime, publishTime: message.publishTime, sequence: message.sequence, schema: type.fullName.slice(1), ...content });
  }
  return found;
}

export const seconds = (timestamp) => timestamp.seconds + 1e-9 * timestamp.nanos;

// Of a cloud: x, y, z, red, green, blue, alpha of each point.
export function points(cloud) {
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  const read = (field, at) => (field.type === "FLOAT32" ? view.getFloat32(at + field.offset, true) : view.getUint8(at + field.offset));
  return Array.from({ length: cloud.data.length / cloud.pointStride }, (_, i) =>
    Object.fromEntries(cloud.fields.map((field) => [field.name, read(field, i * cloud.pointStride)])));
}

// SPDX-License-Identifier: BSD-3-Clause
// What the libraries of MCAP and protobuf find in exports, beside what the records hold.
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { crc32 } from "@foxglove/crc";
import { FOLDER, exported, fly, indexed, points, rows, seconds, streamed, topics } from "./flights.mjs";

after(() => rmSync(FOLDER, { recursive: true }));

const near = (a, b, within, what) => assert.ok(Math.abs(a - b) <= within, `${what}: ${a} where ${b} stands`);
const vector = (v) => [v.x, v.y, v.z];

// Of flights that know their own state.
function statesAgree(record, found, rotors) {
  const states = rows(record, "SELECT v.*, mode.mode, pad.px AS x, pad.py AS y, pad.pz AS z, air.vx AS ax, air.vy AS ay, air.vz AS az, r.px AS rx, r.py AS ry, r.pz AS rz, rotor.* FROM rotor JOIN vehicle v USING (t) JOIN mode USING (t) JOIN pad USING (t) JOIN air USING (t) JOIN reference r USING (t) WHERE v.source = 'true' AND pad.source = 'true' ORDER BY v.t");
  assert.equal(states.length, found.get("/state").length);
  found.get("/state").forEach((message, i) => {
    const s = states[i];
    assert.equal(message.mode, s.mode);
    near(seconds(message.timestamp), s.t, 1e-9, "time");
    near(message.speedMps, Math.hypot(s.vx, s.vy, s.vz), 1e-9, "speed");
    near(message.climbRateMps, s.vz, 1e-9, "climb rate");
    near(message.padDistanceM, Math.hypot(s.px - s.x, s.py - s.y), 1e-9, "distance");
    near(message.padHeightM, s.pz - s.z, 1e-9, "height");
    near(message.airSpeedMps, Math.hypot(s.ax, s.ay, s.az), 1e-9, "air");
    near(message.trackingErrorM, Math.hypot(s.rx - s.px, s.ry - s.py, s.rz - s.pz), 1e-9, "tracking");
    assert.equal(message.thrustsN.length, rotors);
    message.thrustsN.forEach((thrust, rotor) => near(thrust, s[`thrust${rotor}`], 1e-9, "thrust"));
    near(message.ownErrorM, 0, 0, "own error: the state is known");
    assert.ok(Number.isNaN(message.goalDistanceM));
  });
}

describe("a landing", () => {
  let record, bytes, found;
  before(async () => {
    record = fly("landing", "straight_turn");
    bytes = exported(record, "landing");
    found = await topics(bytes);
  });
  const count = (table) => rows(record, `SELECT count(*) AS n FROM ${table}`)[0].n;

  test("is read by both readers, which agree", async () => {
    const reader = await indexed(bytes);
    const records = streamed(bytes);
    const messages = records.filter((one) => one.type === "Message");
    assert.equal(BigInt(messages.length), reader.statistics.messageCount);
    assert.equal(messages.length, [...found.values()].reduce((sum, list) => sum + list.length, 0));
    for (const [id, channel] of reader.channelsById) {
      const of = messages.filter((message) => message.channelId === id);
      assert.equal(BigInt(of.length), reader.statistics.channelMessageCounts.get(id), channel.topic);
      of.forEach((message, i) => assert.equal(message.sequence, i));
      assert.equal(channel.messageEncoding, "protobuf");
      assert.ok(channel.metadata.get("about").length > 0);
    }
    assert.ok(reader.chunkIndexes.length >= 3);
    assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
    assert.equal(reader.statistics.schemaCount, reader.schemasById.size);
    assert.equal(reader.statistics.channelCount, reader.channelsById.size);
  });

  test("has checksums that a damaged byte is found by", async () => {
    const end = streamed(bytes).find((one) => one.type === "DataEnd");
    const footer = bytes.length - 8 - 29;
    const summary = Number(bytes.readBigUInt64LE(footer + 9));
    assert.equal(crc32(bytes.subarray(0, summary - 13)), end.dataSectionCrc);
    const [{ chunkStartOffset, chunkLength }] = (await indexed(bytes)).chunkIndexes;
    const damaged = (at) => {
      const copy = Buffer.from(bytes);
      copy[at] ^= 1;
      return copy;
    };
    assert.throws(() => streamed(damaged(Number(chunkStartOffset + chunkLength) - 5)), /CRC/);
    await assert.rejects(indexed(damaged(bytes.length - 60)), /CRC/);
  });

  test("repeats bit by bit", () => assert.ok(exported(record, "again").equals(bytes)));

  test("tells time from its beginning, in order, once", () => {
    const [{ end }] = rows(record, "SELECT max(t) AS end FROM (SELECT t FROM vehicle UNION SELECT t FROM event)");
    for (const [topic, messages] of found) {
      let last = -1n;
      for (const message of messages) {
        assert.equal(message.logTime, message.publishTime);
        assert.ok(message.logTime >= last && message.logTime <= BigInt(Math.round(end * 1e9)), topic);
        last = message.logTime;
        const stamps = [message.timestamp, ...(message.transforms ?? []).map((one) => one.timestamp), ...(message.entities ?? []).map((one) => one.timestamp)];
        for (const stamp of stamps.filter(Boolean)) near(seconds(stamp), 1e-9 * Number(message.logTime), 1e-9, topic);
      }
    }
  });

  test("has as many messages as the record has rows", () => {
    const plans = count("plan"), beliefs = count("pad WHERE source = 'estimate'");
    const expected = {
      "/tf": count("vehicle WHERE source = 'true'"),
      "/tf_static": 1,
      "/scene": 1,
      "/points/obstacles": 1,
      "/state": count("mode"),
      "/step": plans,
      "/plan": plans,
      "/scene/plan": plans,
      "/points/plan": plans,
      "/pad/belief": beliefs,
      "/log": 1 + count("event") + count("plan WHERE reason <> 'none'"),
    };
    for (const [topic, number] of Object.entries(expected)) assert.equal(found.get(topic)?.length, number, topic);
    assert.equal(found.get("/points/flown").length, found.get("/flown").length);
    // A line has two ends: the first one comes later.
    assert.equal(found.get("/scene/flown").length, found.get("/flown").length - 1);
    for (const { entities } of found.get("/scene/flown")) assert.ok(entities[0].lines[0].points.length > 1);
    assert.ok(!found.has("/camera/down/image") && !found.has("/points/goal"));
  });

  // Foxglove leaves a cloud where its frame was at the message's time.
  test("has the clouds of what moves ten times a second", () => {
    for (const [topic, frame] of [["/points/vehicle", "vehicle"], ["/points/pad", "pad"]]) {
      const clouds = found.get(topic);
      assert.equal(clouds.length, Math.ceil(found.get("/tf").length / 5));
      clouds.forEach((cloud, i) => {
        near(seconds(cloud.timestamp), i / 10, 1e-6, topic);
        assert.equal(cloud.frameId, frame);
        assert.deepEqual(points(cloud), points(clouds[0]));
      });
      const bytes = clouds[0].data.length;
      assert.ok(bytes > 16 * 100 && bytes <= 16 * 1000, `${topic}: ${bytes} bytes`);
    }
  });

  test("has the frames where they truly were", () => {
    const vehicle = rows(record, "SELECT * FROM vehicle WHERE source = 'true' ORDER BY t");
    const pad = rows(record, "SELECT * FROM pad WHERE source = 'true' ORDER BY t");
    found.get("/tf").forEach((message, i) => {
      near(1e-9 * Number(message.logTime), vehicle[i].t, 1e-6, "time");
      const frame = (name) => message.transforms.find((one) => one.childFrameId === name);
      const body = frame("vehicle"), deck = frame("pad");
      assert.equal(body.parentFrameId, "world");
      for (const axis of ["x", "y", "z"]) {
        near(body.translation[axis], vehicle[i][`p${axis}`], 1e-6, "vehicle");
        near(deck.translation[axis], pad[i][`p${axis}`], 1e-6, "pad");
      }
      const q = body.rotation, dot = q.x * vehicle[i].qx + q.y * vehicle[i].qy + q.z * vehicle[i].qz + q.w * vehicle[i].qw;
      near(Math.abs(dot), 1, 1e-9, "attitude");
      near(2 * Math.atan2(deck.rotation.z, deck.rotation.w), pad[i].yaw, 1e-6, "yaw of the pad");
    });
    const still = found.get("/tf_static")[0].transforms;
    assert.deepEqual(still.map((one) => [one.parentFrameId, one.childFrameId]), [["vehicle", "camera_down"], ["vehicle", "camera_depth"]]);
    // z of a camera looks along its axis: down, and ahead.
    const axis = ({ x, y, z, w }) => [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
    axis(still[0].rotation).forEach((value, i) => near(value, [0, 0, -1][i], 1e-9, "camera_down"));
    axis(still[1].rotation).forEach((value, i) => near(value, [1, 0, 0][i], 1e-9, "camera_depth"));
  });

  test("has the pad as it was believed to be, with three sigma around it", () => {
    const beliefs = rows(record, "SELECT * FROM pad WHERE source = 'estimate' ORDER BY t");
    found.get("/pad/belief").forEach((message, i) => {
      near(seconds(message.timestamp), beliefs[i].t, 1e-6, "time");
      for (const axis of ["x", "y", "z"]) near(message.pose.position[axis], beliefs[i][`p${axis}`], 0, "belief");
    });
    for (const message of found.get("/scene/pad_belief")) {
      const belief = beliefs.find((one) => Math.abs(one.t - seconds(message.entities[0].timestamp)) < 1e-6);
      const [line] = message.entities[0].lines;
      assert.equal(line.type, "LINE_LOOP");
      const determinant = belief.cov_xx * belief.cov_yy - belief.cov_xy ** 2;
      for (const p of line.points) {
        const x = p.x - belief.px, y = p.y - belief.py;
        const squared = (belief.cov_yy * x * x - 2 * belief.cov_xy * x * y + belief.cov_xx * y * y) / determinant;
        near(Math.sqrt(squared), 3, 1e-6, "sigma");
      }
    }
  });

  test("has the plans, from now to their end", () => {
    const plans = rows(record, "SELECT * FROM plan ORDER BY id");
    const control = rows(record, "SELECT * FROM control_point ORDER BY plan, i");
    plans.forEach((plan, i) => {
      const q = control.filter((one) => one.plan === plan.id);
      const end = ["x", "y", "z"].map((axis) => (q.at(-3)[axis] + 4 * q.at(-2)[axis] + q.at(-1)[axis]) / 6);
      const poses = found.get("/plan")[i].poses;
      const line = found.get("/scene/plan")[i].entities[0].lines[0].points, cloud = points(found.get("/points/plan")[i]);
      assert.equal(line.length, poses.length);
      assert.equal(cloud.length, poses.length);
      if (plan.t0 + (q.length - 3) * plan.h <= plan.t_now) return assert.equal(poses.length, 0);
      [poses.at(-1).position, line.at(-1), cloud.at(-1)].forEach((p) => vector(p).forEach((value, axis) => near(value, end[axis], 1e-5, `end of plan ${i}`)));
    });
  });

  test("has the way that was flown until then", () => {
    const vehicle = rows(record, "SELECT t, px, py, pz FROM vehicle WHERE source = 'true' ORDER BY t");
    for (const message of found.get("/flown")) {
      const t = seconds(message.timestamp);
      assert.equal(message.poses.length, Math.floor(10 * t + 1e-6) + 1);
      const last = vehicle.find((one) => one.t > Math.floor(10 * t + 1e-6) / 10 - 1e-6);
      ["x", "y", "z"].forEach((axis) => near(message.poses.at(-1).position[axis], last[`p${axis}`], 1e-6, "flown"));
    }
  });

  test("has the steps with their figures", () => {
    const steps = rows(record, "SELECT plan.*, latency_s, wall_s, cpu_s FROM plan JOIN plan_timing ON plan_timing.plan = id ORDER BY id");
    assert.equal(steps.length, found.get("/step").length);
    found.get("/step").forEach((message, i) => {
      const step = steps[i];
      assert.deepEqual([message.step, message.status, message.reason, message.fromOdometry], [step.id, step.status, step.reason, step.from_odometry === 1]);
      for (const name of ["pairs", "solves", "rebinds", "iterations", "work"]) assert.equal(message[name], step[name], name);
      near(seconds(message.timestamp), step.t_now, 1e-9, "t_now");
      near(message.tStartS, step.t_start, 0, "t_start");
      if (step.cost !== null) near(message.cost, step.cost, 0, "cost");
      near(message.wallMs, 1e3 * step.wall_s, 1e-9, "wall_ms");
      near(message.cpuMs, 1e3 * step.cpu_s, 1e-9, "cpu_ms");
      near(message.latencyMs, 1e3 * step.latency_s, 1e-9, "latency_ms");
      if (step.clearance !== null) near(message.clearanceM, step.clearance, 0, "clearance");
    });
  });

  test("has the states with their figures", () => {
    statesAgree(record, found, 4);
    const [{ value }] = rows(record, "SELECT value FROM meta WHERE key = 'result_json'");
    const least = Math.min(...found.get("/state").map((message) => message.clearanceM));
    near(least, JSON.parse(value).min_clearance_m, 0.02, "least clearance, by samples");
  });

  test("has the map: its cells, and what is new of them, twice a second at most", () => {
    const windows = rows(record, "SELECT w.*, t_now FROM map_window w JOIN replan_input USING (plan) ORDER BY plan");
    const changes = rows(record, "SELECT * FROM map_change ORDER BY rowid");
    const meta = Object.fromEntries(rows(record, "SELECT key, value FROM meta").map((row) => [row.key, row.value]));
    const size = meta.map_size.split(" ").map(Number), cell = Number(meta.map_resolution);
    const maps = [];
    let occupied = new Set(), at = 0;
    for (const window of windows) {
      const origin = [window.ix, window.iy, window.iz];
      occupied = new Set([...occupied].filter((key) => key.split(" ").every((index, axis) => index - origin[axis] >= 0 && index - origin[axis] < size[axis])));
      for (; at < changes.length && changes[at].plan === window.plan; ++at) {
        const { ix, iy, iz, count: length, state } = changes[at];
        for (let x = ix; x < ix + length; ++x) occupied[state === "occupied" ? "add" : "delete"](`${x} ${iy} ${iz}`);
      }
      maps.push([window.t_now, occupied]);
      occupied = new Set(occupied);
    }
    const cells = (message) => points(message).map((p) => ["x", "y", "z"].map((axis) => Math.round(p[axis] / cell - 0.5)).join(" "));
    let before = new Set(), last = -Infinity;
    const all = found.get("/map/occupied");
    assert.equal(all.length, found.get("/map/changes").length);
    all.forEach((message, i) => {
      const t = seconds(message.timestamp);
      assert.ok(t - last >= 0.5 - 1e-6, `${t - last} s`);
      last = t;
      const [, now] = maps.find(([time]) => Math.abs(time - t) < 1e-6);
      assert.deepEqual(cells(message).sort(), [...now].sort());
      assert.deepEqual(cells(found.get("/map/changes")[i]).sort(), [...now].filter((key) => !before.has(key)).sort());
      before = now;
    });
    assert.ok(before.size > 1000);
    assert.ok(windows.at(-1).t_now - last < 0.6);
  });

  test("has the events and why a step made no plan", () => {
    const log = found.get("/log").map((message) => [seconds(message.timestamp), message.level, message.message]);
    const said = (kind) => log.filter(([, , words]) => words.startsWith(kind));
    for (const event of rows(record, "SELECT * FROM event")) {
      assert.ok(log.some(([t, , words]) => Math.abs(t - event.t) < 1e-6 && words.startsWith(`${event.kind}: ${event.text}`)), `${event.kind}: ${event.text}`);
    }
    assert.deepEqual(said("mode")[0], [0, "INFO", "mode: hovering"]);
    assert.equal(said("outcome")[0][1], "INFO");
    const failed = rows(record, "SELECT id, reason FROM plan WHERE reason <> 'none'");
    assert.ok(failed.length > 0);
    failed.forEach(({ id, reason }, i) => {
      assert.equal(said("plan")[i][1], "WARNING");
      assert.ok(said("plan")[i][2].includes(`step ${id}: ${reason}`));
    });
  });

  test("says what it is of", async () => {
    const words = [];
    for await (const { name, metadata } of (await indexed(bytes)).readMetadata()) words.push([name, Object.fromEntries(metadata)]);
    const meta = Object.fromEntries(rows(record, "SELECT key, value FROM meta").map((row) => [row.key, row.value]));
    assert.equal(words.length, 1);
    const [name, facts] = words[0];
    assert.equal(name, "touchdown");
    const { scenario, seed, scenario_yaml, revision, touchdown_version } = meta;
    assert.deepEqual(facts, { scenario, seed, scenario_yaml, revision, touchdown_version, planner: "landing", solver: "banded", outcome: "landed" });
  });
});

test("a vehicle of 27 g has its thrusts", async () => {
  const record = fly("nano", "open", "--set", "vehicle=docs/examples/vehicles/nano.xml", "--set", "timeout=1");
  const found = await topics(exported(record, "nano"));
  statesAgree(record, found, 4);
  assert.ok(found.get("/state").some(({ thrustsN }) => thrustsN.every((thrust) => thrust > 0 && thrust < 0.3)));
});

test("every kind of obstacle is there as it is", async () => {
  const record = fly("kinds", "docs/examples/worlds/all_kinds.yaml", "--set", "timeout=1");
  const found = await topics(exported(record, "kinds"));
  const entities = new Map(found.get("/scene")[0].entities.map((entity) => [entity.id, entity]));
  const kinds = new Set(), taken = new Map();
  for (const row of rows(record, "SELECT * FROM obstacle")) {
    const entity = entities.get(row.key);
    assert.equal(entity.frameId, "world");
    kinds.add(row.kind);
    const i = taken.get(row.key) ?? 0; // a wall is several boxes
    taken.set(row.key, i + 1);
    const shape = entity[{ box: "cubes", cylinder: "cylinders", sphere: "spheres", mesh: "triangles" }[row.kind]][i];
    const centre = [row.cx, row.cy, row.cz], size = [row.size_x, row.size_y, row.size_z];
    if (row.kind === "mesh") {
      const low = [0, 1, 2].map((axis) => Math.min(...shape.points.map((p) => vector(p)[axis])));
      const high = [0, 1, 2].map((axis) => Math.max(...shape.points.map((p) => vector(p)[axis])));
      size.forEach((length, axis) => near(high[axis] - low[axis], length, 1e-5, row.key));
      centre.forEach((value, axis) => near((high[axis] + low[axis]) / 2, value, 1e-5, row.key));
      assert.ok(shape.indices.length % 3 === 0 && shape.indices.every((index) => index < shape.points.length));
    } else {
      vector(shape.pose.position).forEach((value, axis) => near(value, centre[axis], 1e-9, row.key));
      vector(shape.size).forEach((value, axis) => near(value, size[axis], 1e-9, row.key));
      near(2 * Math.atan2(shape.pose.orientation.z, shape.pose.orientation.w), row.yaw ?? 0, 1e-9, row.key);
    }
  }
  assert.deepEqual([...kinds].sort(), ["box", "cylinder", "mesh", "sphere"]);
  assert.deepEqual([entities.get("vehicle").frameId, entities.get("pad").frameId, entities.get("ground").frameId], ["vehicle", "pad", "world"]);
  assert.ok([...entities.values()].every((entity) => entity.frameLocked));
});

describe("a flight with rendered images", () => {
  let record, bytes, found;
  before(async () => {
    record = fly("rendered", "straight_turn", "--set", "sensing=rendered", "--set", "timeout=2");
    bytes = exported(record, "rendered");
    found = await topics(bytes);
  });

  test("has them at the cameras' rates, with their calibrations", () => {
    const [{ end }] = rows(record, "SELECT max(t) AS end FROM vehicle");
    for (const [name, rate, width, height, focal] of [["down", 20, 320, 240, 120], ["depth", 10, 80, 60, 40]]) {
      const images = found.get(`/camera/${name}/image`), calibrations = found.get(`/camera/${name}/calibration`);
      assert.equal(images.length, Math.floor(end * rate + 1e-6) + 1);
      assert.equal(calibrations.length, images.length);
      images.forEach((image, i) => {
        near(seconds(image.timestamp), i / rate, 1e-9, "time");
        assert.equal(image.frameId, `camera_${name}`);
        const { K, frameId } = calibrations[i];
        assert.deepEqual([calibrations[i].width, calibrations[i].height, frameId], [width, height, image.frameId]);
        K.forEach((value, k) => near(value, [focal, 0, width / 2 - 0.5, 0, focal, height / 2 - 0.5, 0, 0, 1][k], 1e-9, "K"));
      });
    }
  });

  test("has images that are images", () => {
    for (const { data, format } of found.get("/camera/down/image")) {
      const png = Buffer.from(data);
      assert.equal(format, "png");
      assert.equal(png.subarray(0, 8).toString("latin1"), "\x89PNG\r\n\x1a\n");
      assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20), png[24], png[25]], [320, 240, 8, 0]);
    }
    const seen = new Set();
    for (const image of found.get("/camera/depth/image")) {
      assert.deepEqual([image.width, image.height, image.encoding, image.step, image.data.length], [80, 60, "16UC1", 160, 9600]);
      const view = new DataView(image.data.buffer, image.data.byteOffset);
      for (let at = 0; at < image.data.length; at += 2) seen.add(view.getUint16(at, true));
    }
    assert.ok(seen.has(0) && seen.size > 100); // the sky, and many depths
    assert.ok(Math.max(...seen) <= 6000 && Math.min(...[...seen].filter(Boolean)) > 200); // within the range [mm]
  });

  test("has depths that lie on what is there, by frames and calibration", () => {
    const obstacles = rows(record, "SELECT * FROM obstacle");
    assert.ok(obstacles.every(({ kind }) => kind === "cylinder" || kind === "box"));
    const placed = ({ translation, rotation: { x, y, z, w } }, v) => {
      const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
      return [v[0] + w * t[0] + y * t[2] - z * t[1] + translation.x, v[1] + w * t[1] + z * t[0] - x * t[2] + translation.y, v[2] + w * t[2] + x * t[1] - y * t[0] + translation.z];
    };
    const toSurface = (outside) => (Math.max(...outside) > 0 ? Math.hypot(...outside.map((e) => Math.max(e, 0))) : -Math.max(...outside));
    const distance = (o, p) => toSurface([...(o.kind === "cylinder" ? [Math.hypot(p[0] - o.cx, p[1] - o.cy) - o.size_x / 2] : [Math.abs(p[0] - o.cx) - o.size_x / 2, Math.abs(p[1] - o.cy) - o.size_y / 2]), Math.abs(p[2] - o.cz) - o.size_z / 2]);
    const camera = found.get("/tf_static")[0].transforms.find((one) => one.childFrameId === "camera_depth");
    const { K } = found.get("/camera/depth/calibration")[0];
    const distances = [];
    for (const image of found.get("/camera/depth/image")) {
      const frames = found.get("/tf").find((one) => Math.abs(Number(one.logTime - image.logTime)) < 1e6)?.transforms;
      if (!frames) continue;
      const [body, { translation: pad }] = ["vehicle", "pad"].map((name) => frames.find((one) => one.childFrameId === name));
      const view = new DataView(image.data.buffer, image.data.byteOffset);
      for (let row = 0; row < image.height; row += 3) {
        for (let column = 0; column < image.width; column += 3) {
          const z = view.getUint16(row * image.step + 2 * column, true) / 1e3;
          if (z === 0) continue;
          const p = placed(body, placed(camera, [(column - K[2]) / K[0] * z, (row - K[5]) / K[4] * z, z]));
          if (Math.hypot(p[0] - pad.x, p[1] - pad.y) < 1.2) continue;
          distances.push(Math.min(Math.abs(p[2]), ...obstacles.map((o) => Math.abs(distance(o, p)))));
        }
      }
    }
    distances.sort((a, b) => a - b);
    assert.ok(distances.length > 1000, `${distances.length} depths`);
    assert.ok(distances[distances.length >> 1] < 0.002, `median ${distances[distances.length >> 1]} m`);
    assert.ok(distances[Math.floor(0.95 * distances.length)] < 0.02, `95 %: ${distances[Math.floor(0.95 * distances.length)]} m`);
  });

  test("is small enough for ten seconds to be below 20 MB", () => {
    const [{ end }] = rows(record, "SELECT max(t) AS end FROM vehicle");
    assert.ok(bytes.length / end < 2e6, `${bytes.length} bytes for ${end} s`);
  });
});

test("large images come less often", async () => {
  const record = fly("large", "open", "--set", "sensing=rendered", "--set", "timeout=1", ...["camera.width=640", "camera.height=480", "depth.width=320", "depth.height=240"].flatMap((key) => ["--set", key]));
  const bytes = exported(record, "large");
  const found = await topics(bytes);
  for (const [name, rate] of [["down", 1.0e6 / (0.6 * 640 * 480)], ["depth", 0.2e6 / (320 * 240)]]) {
    const images = found.get(`/camera/${name}/image`);
    assert.equal(images.length, Math.floor(rate) + 1);
    images.forEach((image, i) => near(seconds(image.timestamp), i / rate, 1e-9, "time"));
  }
  assert.ok(bytes.length < 2e6, `${bytes.length} bytes for 1 s`);
});

test("images of nothing but noise come less often", async () => {
  const record = fly("noisy", "straight_turn", "--set", "sensing=rendered", "--set", "camera.noise=100", "--set", "timeout=2");
  const bytes = exported(record, "noisy");
  const [{ end }] = rows(record, "SELECT max(t) AS end FROM vehicle");
  const images = (await topics(bytes)).get("/camera/down/image");
  const size = images.reduce((sum, { data }) => sum + data.length, 0);
  const pixels = images.length * 320 * 240;
  assert.ok(size > 0.9 * pixels, `${size} bytes for ${pixels} pixels`);
  assert.ok(size / end < 1.1e6 && bytes.length / end < 2e6, `${size} bytes of ${bytes.length} for ${end} s`);
});

test("a flight to a goal has the goal in the place of the pad", async () => {
  const record = fly("goal", "goal", "--set", "timeout=2");
  const found = await topics(exported(record, "goal"));
  assert.ok(!found.has("/pad/belief") && !found.has("/points/pad") && found.has("/points/goal"));
  const vehicle = rows(record, "SELECT px, py, pz FROM vehicle WHERE source = 'true' ORDER BY t");
  found.get("/state").forEach((message, i) => {
    const frames = found.get("/tf")[i].transforms;
    assert.deepEqual(frames.map((one) => one.childFrameId), ["vehicle", "goal"]);
    const goal = frames[1].translation;
    near(message.goalDistanceM, Math.hypot(goal.x - vehicle[i].px, goal.y - vehicle[i].py, goal.z - vehicle[i].pz), 1e-6, "distance");
    for (const name of ["padDistanceM", "padHeightM", "padSpeedMps", "padErrorM", "padSigmaM"]) assert.ok(Number.isNaN(message[name]), name);
  });
  const outcome = found.get("/log").find((message) => message.message.startsWith("outcome: timeout"));
  assert.equal(outcome.level, "ERROR");
});

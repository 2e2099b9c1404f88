// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/fuzz/seeds.mjs FOLDER: a small valid file or two for each fuzz target, in FOLDER/TARGET/, from
// which libFuzzer begins. All are made here, or are the project's own examples.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync, gzipSync } from "node:zlib";

const source = join(dirname(fileURLToPath(import.meta.url)), "../..");
const folder = process.argv[2];
if (!folder) {
  console.error("usage: node tests/fuzz/seeds.mjs FOLDER");
  process.exit(2);
}
const seed = (target, name, bytes) => {
  mkdirSync(join(folder, target), { recursive: true });
  writeFileSync(join(folder, target, name), bytes);
};
const example = (path) => readFileSync(join(source, "examples", path));

/// Of zip archives and PNG; Node.js has it since version 22 only.
const crc32 = (bytes) => {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
};

// A tetrahedron.
const vertices = [[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]];
const triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

// STL.
const binary = Buffer.alloc(84 + 50 * triangles.length);
binary.writeUInt32LE(triangles.length, 80);
triangles.forEach((triangle, t) =>
  triangle.forEach((v, c) => vertices[v].forEach((x, k) => binary.writeFloatLE(x, 84 + 50 * t + 12 * (c + 1) + 4 * k))));
seed("stl", "binary", binary);
seed("stl", "ascii", `solid a\n${triangles.map((t) =>
  ` facet normal 0 0 0\n  outer loop\n${t.map((v) => `   vertex ${vertices[v].join(" ")}\n`).join("")}  endloop\n endfacet\n`)
  .join("")}endsolid a\n`);
// OBJ.
const lines = (rows) => rows.map((row) => `${row}\n`).join("");
seed("obj", "plain", lines(vertices.map((v) => `v ${v.join(" ")}`)) + lines(triangles.map((t) => `f ${t.map((v) => v + 1).join(" ")}`)));
seed("obj", "relative", `mtllib a.mtl\no one\ng two\nusemtl x\n${lines(vertices.map((v) => `v ${v.join(" ")} 1 0.5 0`))}vt 0 0\nvn 0 0 1\n` +
  "f -4/1/1 -2/1/1 -3/1/1\nf 1//1 2//1 4//1\nf 1 4 3 \\\n2\n");
// PLY.
const header = (format) => `ply\nformat ${format} 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n` +
  "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
seed("ply", "ascii", header("ascii") + lines(vertices.map((v) => `${v.join(" ")} 255 0 0`)) + lines(triangles.map((t) => `3 ${t.join(" ")}`)));
for (const [format, little] of [["binary_little_endian", true], ["binary_big_endian", false]]) {
  const body = Buffer.alloc(15 * 4 + 13 * 4);
  vertices.forEach((v, i) => v.forEach((x, k) => (little ? body.writeFloatLE(x, 15 * i + 4 * k) : body.writeFloatBE(x, 15 * i + 4 * k))));
  triangles.forEach((t, i) => {
    body[60 + 13 * i] = 3;
    t.forEach((v, k) => (little ? body.writeInt32LE(v, 61 + 13 * i + 4 * k) : body.writeInt32BE(v, 61 + 13 * i + 4 * k)));
  });
  seed("ply", format, Buffer.concat([Buffer.from(header(format)), body]));
}
// glTF and GLB.
const data = Buffer.alloc(48 + 24);
vertices.forEach((v, i) => v.forEach((x, k) => data.writeFloatLE(x / 1000, 12 * i + 4 * k)));
triangles.flat().forEach((v, i) => data.writeUInt16LE(v, 48 + 2 * i));
const gltf = (buffer) => JSON.stringify({
  asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, translation: [0, 0, 1], scale: [1, 2, 1] }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }], buffers: [{ byteLength: 72, ...buffer }],
  bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 24 }],
  accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: "VEC3", min: [0, 0, 0], max: [0.01, 0.01, 0.01] },
    { bufferView: 1, componentType: 5123, count: 12, type: "SCALAR" }],
});
seed("gltf", "embedded", gltf({ uri: `data:application/octet-stream;base64,${data.toString("base64")}` }));
const glb = (json, body) => {
  const text = Buffer.from(json + " ".repeat((4 - (json.length % 4)) % 4));
  const head = Buffer.alloc(20), chunk = Buffer.alloc(8);
  head.write("glTF");
  [2, 28 + text.length + body.length, text.length, 0x4e4f534a].forEach((x, i) => head.writeUInt32LE(x, 4 + 4 * i));
  [body.length, 0x004e4942].forEach((x, i) => chunk.writeUInt32LE(x, 4 * i));
  return Buffer.concat([head, text, chunk, body]);
};
for (const target of ["gltf", "glb", "hand"]) seed(target, "glb", glb(gltf({}), data));
// 3MF: a zip archive, one file as it is, one packed.
const zip = (files) => {
  const parts = [], directory = [];
  let at = 0;
  for (const [name, text] of files) {
    const bytes = Buffer.from(text), local = Buffer.alloc(30), entry = Buffer.alloc(46);
    local.writeUInt32LE(0x04034b50, 0);
    entry.writeUInt32LE(0x02014b50, 0);
    for (const [record, offset] of [[local, 4], [entry, 6]]) {
      record.writeUInt16LE(20, offset);
      record.writeUInt32LE(crc32(bytes), offset + 10);
      record.writeUInt32LE(bytes.length, offset + 14);
      record.writeUInt32LE(bytes.length, offset + 18);
      record.writeUInt16LE(name.length, offset + 22);
    }
    entry.writeUInt32LE(at, 42);
    parts.push(local, Buffer.from(name), bytes);
    directory.push(entry, Buffer.from(name));
    at += 30 + name.length + bytes.length;
  }
  const end = Buffer.alloc(22), all = Buffer.concat(directory);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(files.length, 8);
  end.writeUInt16LE(files.length, 10);
  end.writeUInt32LE(all.length, 12);
  end.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, all, end]);
};
const model = `<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>` +
  `<object id="1" type="model"><mesh><vertices>${vertices.map((v) => `<vertex x="${v[0]}" y="${v[1]}" z="${v[2]}"/>`).join("")}</vertices>` +
  `<triangles>${triangles.map((t) => `<triangle v1="${t[0]}" v2="${t[1]}" v3="${t[2]}"/>`).join("")}</triangles></mesh></object></resources>` +
  `<build><item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></build></model>`;
seed("three_mf", "stored", zip([
  ["_rels/.rels", `<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">` +
    `<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>`],
  ["3D/3dmodel.model", model]]));
// PNG of 2 x 2 pixels; the heads of a JPEG with the data of a camera.
const chunk = (type, body) => {
  const bytes = Buffer.alloc(12 + body.length);
  bytes.writeUInt32BE(body.length, 0);
  bytes.write(type, 4);
  body.copy(bytes, 8);
  bytes.writeUInt32BE(crc32(bytes.subarray(4, 8 + body.length)), 8 + body.length);
  return bytes;
};
const ihdr = Buffer.from([0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 0]);
seed("picture", "png", Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", ihdr),
  chunk("IDAT", deflateSync(Buffer.alloc(14, 90))), chunk("IEND", Buffer.alloc(0))]));
const tiff = Buffer.alloc(50);
tiff.write("II*\0", "latin1");
tiff.writeUInt32LE(8, 4);
tiff.writeUInt16LE(3, 8);
[[0x0112, 3, 1, 1], [0x8769, 4, 1, 8], [0xa405, 3, 1, 28]].forEach(([tag, type, count, value], i) => {
  tiff.writeUInt16LE(tag, 10 + 12 * i);
  tiff.writeUInt16LE(type, 12 + 12 * i);
  tiff.writeUInt32LE(count, 14 + 12 * i);
  tiff.writeUInt32LE(value, 18 + 12 * i);
});
const jpeg = Buffer.concat([Buffer.from([0xff, 0xd8, 0xff, 0xe1, 0, tiff.length + 8]), Buffer.from("Exif\0\0", "latin1"), tiff,
  Buffer.from([0xff, 0xd9])]);
seed("exif", "jpeg", jpeg);
seed("picture", "jpeg", jpeg);
// NIfTI-1 of 2 x 2 x 2 voxels.
const nifti = Buffer.alloc(352 + 16);
nifti.writeInt32LE(348, 0);
[3, 2, 2, 2, 1, 1, 1, 1].forEach((x, i) => nifti.writeInt16LE(x, 40 + 2 * i));
nifti.writeInt16LE(4, 70);
nifti.writeInt16LE(16, 72);
[1, 1, 1, 1].forEach((x, i) => nifti.writeFloatLE(x, 76 + 4 * i));
nifti.writeFloatLE(352, 108);
nifti.writeInt16LE(1, 254);
[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]].flat().forEach((x, i) => nifti.writeFloatLE(x, 280 + 4 * i));
nifti.write("n+1\0", 344, "latin1");
seed("nifti", "plain", nifti);
seed("nifti", "gzip", gzipSync(nifti));
// DICOM: explicit, little-endian, some elements of an MR slice.
const element = (group, tag, vr, value) => {
  const long = ["OB", "OW", "SQ", "UN"].includes(vr), bytes = Buffer.isBuffer(value) ? value : Buffer.from(value + (value.length % 2 ? " " : ""));
  const head = Buffer.alloc(long ? 12 : 8);
  head.writeUInt16LE(group, 0);
  head.writeUInt16LE(tag, 2);
  head.write(vr, 4);
  if (long) head.writeUInt32LE(bytes.length, 8);
  else head.writeUInt16LE(bytes.length, 6);
  return Buffer.concat([head, bytes]);
};
const short = (x) => Buffer.from([x & 255, x >> 8]);
seed("dicom", "slice", Buffer.concat([Buffer.alloc(128), Buffer.from("DICM"), element(2, 0x10, "UI", "1.2.840.10008.1.2.1\0"),
  element(8, 0x60, "CS", "MR"), element(0x18, 0x50, "DS", "1"), element(0x20, 0xd, "UI", "1.2.3\0"), element(0x20, 0xe, "UI", "1.2.3.4\0"),
  element(0x20, 0x32, "DS", "0\\0\\0"), element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"), element(0x28, 2, "US", short(1)),
  element(0x28, 4, "CS", "MONOCHROME2"), element(0x28, 0x10, "US", short(2)), element(0x28, 0x11, "US", short(2)),
  element(0x28, 0x30, "DS", "1\\1"), element(0x28, 0x100, "US", short(16)), element(0x28, 0x101, "US", short(16)),
  element(0x28, 0x102, "US", short(15)), element(0x28, 0x103, "US", short(0)), element(0x7fe0, 0x10, "OW", Buffer.alloc(8))]));
// C3D: Intel, floats, two points in one frame.
const c3d = Buffer.alloc(1536);
c3d.writeUInt8(2, 0);
c3d.writeUInt8(0x50, 1);
c3d.writeUInt16LE(2, 2);
c3d.writeUInt16LE(1, 6);
c3d.writeUInt16LE(1, 8);
c3d.writeFloatLE(-1, 12);
c3d.writeUInt16LE(3, 16);
c3d.writeFloatLE(60, 20);
c3d.set([1, 0x50, 1, 84], 512);
let at = 516;
const put = (name, group, body) => {
  c3d.writeInt8(name.length, at);
  c3d.writeInt8(group, at + 1);
  c3d.write(name, at + 2);
  c3d.writeUInt16LE(2 + body.length, at + 2 + name.length);
  body.copy(c3d, at + 4 + name.length);
  at += 4 + name.length + body.length;
};
put("POINT", -1, Buffer.from([0]));
put("UNITS", 1, Buffer.concat([Buffer.from([0xff, 1, 2]), Buffer.from("mm"), Buffer.from([0])]));
put("USED", 1, Buffer.from([2, 0, 2, 0, 0]));
put("LABELS", 1, Buffer.concat([Buffer.from([0xff, 2, 4, 2]), Buffer.from("WR_ATIP_"), Buffer.from([0])]));
[[10, 20, 30, 0], [40, 50, 60, 0]].flat().forEach((x, i) => c3d.writeFloatLE(x, 1024 + 4 * i));
seed("c3d", "floats", c3d);
// Tables and settings: the examples.
seed("csv", "markers", example("closing-hand-markers.csv").subarray(0, 2000));
seed("csv", "spreadsheet", 'sep=;\na;"b ""c""";d\n# x\n1;2,5;3\n');
seed("curves", "fingertip", example("fingertip-xie2014.csv"));
for (const target of ["toml", "sensors"]) seed(target, "mat", example("grip-mat.toml"));
seed("toml", "dotted", 'a.b.c = [1, 2.5, "x", {d = 1979-05-27T07:32:00Z}]\n[e."f g"]\nh = """\ni"""\n[[j]]\nk = 0x1F\n');
seed("study", "handles", example("three-handles/study.toml"));
seed("study", "thesis", example("xie2014-chapter5/study.toml"));
seed("hold", "wrap", 'part = 1\ngrip = "medium_wrap"\nalong_mm = 0\n');
seed("tissue", "soft", "[palm]\nshear_modulus_kpa = 10\n");
seed("population", "two", 'name = "two"\n[[dimension]]\nname = "hand_length"\nmean_mm = 190\nsd_mm = 9\n');
seed("dimension_table", "people", "name,hand_length_mm,hand_width_mm\nA,190,85\nB,175,80\n");
seed("project", "example", example("project/project.toml"));
seed("bench_project", "empty", "{}");
seed("study_plan", "empty", "{}");
seed("face_mesh", "empty", Buffer.alloc(64));

// Reads a recording with MCAP's own reader and prints what it holds as JSON.
//
//   node read.mjs FILE             the whole file, by its index
//   node read.mjs FILE CUT…        for each offset: the messages that the streaming reader finds in the bytes before it
import {readFileSync} from "node:fs";
import {open} from "node:fs/promises";
import {McapIndexedReader, McapStreamReader} from "@mcap/core";
import lz4 from "@foxglove/wasm-lz4";

await lz4.isLoaded;
const decompressHandlers = {lz4: (bytes, size) => lz4(bytes, Number(size))};
const [file, ...cuts] = process.argv.slice(2);

/** Takes the fields of little-endian CDR as the ros2msg schema names them. */
class Cdr {
  constructor(bytes) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (this.view.getUint32(0) !== 0x00010000) throw new Error("not little-endian CDR");
    this.at = 4; // alignment counts from behind the encapsulation
  }
  u8() {
    return this.view.getUint8(this.at++);
  }
  u32() {
    this.at += (4 - (this.at % 4)) % 4;
    this.at += 4;
    return this.view.getUint32(this.at - 4, true);
  }
  string() {
    const length = this.u32();
    this.at += length;
    return Buffer.from(this.view.buffer, this.view.byteOffset + this.at - length, length - 1).toString();
  }
  bytes() {
    const length = this.u32();
    this.at += length;
    if (this.at !== this.view.byteLength) throw new Error("the data are not the end of the message");
    return Buffer.from(this.view.buffer, this.view.byteOffset + this.at - length, length);
  }
  header() {
    return {sec: this.u32(), nanosec: this.u32(), frame_id: this.string()};
  }
}

const sum = (bytes) => bytes.reduce((total, byte) => total + byte, 0);

function decoded(schema, data) {
  if (schema.encoding === "jsonschema") return JSON.parse(new TextDecoder().decode(data));
  const cdr = new Cdr(data);
  const header = cdr.header();
  if (schema.name === "sensor_msgs/msg/CompressedImage") {
    const format = cdr.string();
    const bytes = cdr.bytes();
    return {header, format, is_jpeg: bytes[0] === 0xff && bytes[1] === 0xd8 && bytes.at(-1) === 0xd9};
  }
  const image = {header, height: cdr.u32(), width: cdr.u32(), encoding: cdr.string(), is_bigendian: cdr.u8(), step: cdr.u32()};
  const bytes = cdr.bytes();
  return {...image, bytes: bytes.length, sum: sum(bytes)};
}

async function whole() {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      const {bytesRead} = await handle.read(bytes, 0, bytes.length, Number(offset));
      if (bytesRead !== bytes.length) throw new Error("read beyond the end");
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
  const messages = [];
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    messages.push({topic: channel.topic, sequence: message.sequence, stamp_ns: Number(message.logTime), message: decoded(schema, message.data)});
  }
  const channels = [...reader.channelsById.values()].map((channel) => {
    const schema = reader.schemasById.get(channel.schemaId);
    const text = new TextDecoder().decode(schema.data);
    return {topic: channel.topic, encoding: channel.messageEncoding, schema: schema.name, schema_encoding: schema.encoding,
            schema_text: schema.encoding === "jsonschema" ? JSON.parse(text) : text};
  });
  const metadata = {};
  for await (const record of reader.readMetadata()) metadata[record.name] = Object.fromEntries(record.metadata);
  await handle.close();
  return {profile: reader.header.profile, library: reader.header.library, chunks: reader.chunkIndexes.length,
          message_count: Number(reader.statistics.messageCount), channels, metadata, messages};
}

function messages_before(bytes, cut) {
  const reader = new McapStreamReader({decompressHandlers, validateCrcs: true});
  reader.append(bytes.subarray(0, cut));
  let count = 0;
  for (let record; (record = reader.nextRecord()); ) count += record.type === "Message" ? 1 : 0;
  return count;
}

if (cuts.length === 0) {
  console.log(JSON.stringify(await whole()));
} else {
  const bytes = readFileSync(file);
  console.log(JSON.stringify(cuts.map((cut) => messages_before(bytes, Number(cut)))));
}

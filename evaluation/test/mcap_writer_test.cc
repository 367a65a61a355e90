// SPDX-License-Identifier: BSD-3-Clause
// Bytes of small files beside the format's specification; that other people's readers take whole flights is tested by
// evaluation/mcap/node.
#include "evaluation/mcap/mcap_writer.h"

#include <zlib.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

using ::testing::ElementsAre;

struct Record {
  int op;
  std::size_t at;       // in the bytes that it stands in
  std::string content;  // without kind and length
};

std::uint64_t NumberAt(const std::string& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size - 1; i >= 0; --i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes.at(at + static_cast<std::size_t>(i)));
  }
  return value;
}

std::vector<Record> RecordsIn(const std::string& bytes) {
  std::vector<Record> records;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t length = NumberAt(bytes, at + 1, 8);
    records.push_back({bytes[at], at, bytes.substr(at + 9, length)});
    EXPECT_EQ(records.back().content.size(), length);
    at += 9 + length;
  }
  return records;
}

std::vector<int> OpsOf(const std::vector<Record>& records) {
  std::vector<int> ops;
  for (const Record& record : records) ops.push_back(record.op);
  return ops;
}

std::uint32_t CrcOf(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kMagicSize = 8;

// Two topics of one schema, three messages, the second chunk begins with the last.
std::string SmallFile() {
  std::ostringstream out;
  McapWriter writer(&out, "a library", 200);
  writer.AddMetadata("facts", {{"seed", "7"}, {"of", "a test"}});
  const auto a = writer.AddTopic("/a", "some.Type", "descriptors", {{"about", "first"}});
  const auto b = writer.AddTopic("/b", "some.Type", "descriptors");
  writer.Write(b, 5, "one");
  writer.Write(a, 7, std::string(60, 'x'));
  writer.Write(a, 1'000'000'000'000, "three");
  writer.Finish();
  return out.str();
}

// Of the part between both magics.
std::vector<Record> SmallRecords(const std::string& file) {
  return RecordsIn(file.substr(kMagicSize, file.size() - 2 * kMagicSize));
}

TEST(McapWriter, PutsItsRecordsInTheFormatsOrder) {
  const std::string file = SmallFile();
  EXPECT_EQ(file.substr(0, kMagicSize), kMagic);
  EXPECT_EQ(file.substr(file.size() - kMagicSize), kMagic);
  const std::vector<Record> records = SmallRecords(file);
  // Header, metadata. A chunk with two indices, a chunk with one, end of data. Schema, channels, statistics, chunk
  // indices, metadata index, offsets of these five groups, footer.
  EXPECT_THAT(OpsOf(records),
              ElementsAre(0x01, 0x0C, 0x06, 0x07, 0x07, 0x06, 0x07, 0x0F, 0x03, 0x04, 0x04, 0x0B,
                          0x08, 0x08, 0x0D, 0x0E, 0x0E, 0x0E, 0x0E, 0x0E, 0x02));
  EXPECT_EQ(records[0].content, std::string("\0\0\0\0\x09\0\0\0a library", 17));
  EXPECT_EQ(records[1].content,
            std::string("\x05\0\0\0facts\x1D\0\0\0\x02\0\0\0of\x06\0\0\0a test\x04\0\0\0seed"
                        "\x01\0\0\0"
                        "7",
                        42));
}

TEST(McapWriter, HasTheFormatsChecksums) {
  const std::string file = SmallFile();
  const std::vector<Record> records = SmallRecords(file);
  const Record& end = records[7];
  EXPECT_EQ(NumberAt(end.content, 0, 4), CrcOf(file.substr(0, kMagicSize + end.at)));
  for (const std::size_t chunk : {2, 5}) {
    const std::string& content = records[chunk].content;
    // Two times, size, checksum, compression "", size again.
    const std::size_t size = NumberAt(content, 16, 8);
    EXPECT_EQ(NumberAt(content, 28, 4), 0U);
    EXPECT_EQ(NumberAt(content, 32, 8), size);
    ASSERT_EQ(content.size(), 40 + size);
    EXPECT_EQ(NumberAt(content, 24, 4), CrcOf(content.substr(40)));
  }
  const Record& footer = records.back();
  const std::size_t summary = NumberAt(footer.content, 0, 8);
  EXPECT_EQ(summary, kMagicSize + records[8].at);
  EXPECT_EQ(NumberAt(footer.content, 8, 8), kMagicSize + records[15].at);
  const std::size_t covered = kMagicSize + footer.at + 9 + 16;
  EXPECT_EQ(NumberAt(footer.content, 16, 4), CrcOf(file.substr(summary, covered - summary)));
}

TEST(McapWriter, FindsMessagesByItsIndices) {
  const std::string file = SmallFile();
  const std::vector<Record> records = SmallRecords(file);
  const std::vector<Record> first = RecordsIn(records[2].content.substr(40));
  EXPECT_THAT(OpsOf(first), ElementsAre(0x03, 0x04, 0x04, 0x05, 0x05));
  EXPECT_THAT(OpsOf(RecordsIn(records[5].content.substr(40))), ElementsAre(0x05));
  // Channel, sequence, both times, the given bytes.
  EXPECT_EQ(first[3].content,
            std::string("\x01\0\0\0\0\0\x05\0\0\0\0\0\0\0\x05\0\0\0\0\0\0\0one", 25));
  // Of channel 0: one entry, its time and where the message begins.
  const std::string& index = records[3].content;
  EXPECT_EQ(NumberAt(index, 0, 2), 0U);
  EXPECT_EQ(NumberAt(index, 2, 4), 16U);
  EXPECT_EQ(NumberAt(index, 6, 8), 7U);
  EXPECT_EQ(NumberAt(index, 14, 8), first[4].at);
  // Of the second chunk: times, place, length, and the places of its indices.
  const std::string& chunk = records[13].content;
  EXPECT_EQ(NumberAt(chunk, 0, 8), 1'000'000'000'000U);
  EXPECT_EQ(NumberAt(chunk, 16, 8), kMagicSize + records[5].at);
  EXPECT_EQ(NumberAt(chunk, 24, 8), 9 + records[5].content.size());
  EXPECT_EQ(NumberAt(chunk, 32, 4), 10U);
  EXPECT_EQ(NumberAt(chunk, 38, 8), kMagicSize + records[6].at);
  EXPECT_EQ(NumberAt(chunk, 46, 8), 9 + records[6].content.size());
}

TEST(McapWriter, CountsWhatItHolds) {
  const std::vector<Record> records = SmallRecords(SmallFile());
  const std::string& statistics = records[11].content;
  EXPECT_EQ(NumberAt(statistics, 0, 8), 3U);   // messages
  EXPECT_EQ(NumberAt(statistics, 8, 2), 1U);   // schemas
  EXPECT_EQ(NumberAt(statistics, 10, 4), 2U);  // channels
  EXPECT_EQ(NumberAt(statistics, 14, 4), 0U);  // attachments
  EXPECT_EQ(NumberAt(statistics, 18, 4), 1U);  // metadata
  EXPECT_EQ(NumberAt(statistics, 22, 4), 2U);  // chunks
  EXPECT_EQ(NumberAt(statistics, 26, 8), 5U);  // the first time
  EXPECT_EQ(NumberAt(statistics, 34, 8), 1'000'000'000'000U);
  EXPECT_EQ(NumberAt(statistics, 48, 8), 2U);  // of channel 0
  EXPECT_EQ(NumberAt(statistics, 58, 8), 1U);  // of channel 1
}

TEST(McapWriter, WithoutAnythingIsAFileAllTheSame) {
  std::ostringstream out;
  McapWriter(&out, "").Finish();
  EXPECT_THAT(OpsOf(SmallRecords(out.str())), ElementsAre(0x01, 0x0F, 0x0B, 0x0E, 0x02));
}

TEST(McapWriter, SaysThatAStreamFailed) {
  std::ostringstream out;
  McapWriter writer(&out, "", 1000);
  const auto channel = writer.AddTopic("/a", "some.Type", "descriptors");
  out.setstate(std::ios::badbit);
  EXPECT_NO_THROW(writer.Write(channel, 1, "short"));  // the chunk is still open
  EXPECT_THROW(writer.Write(channel, 2, std::string(1000, 'x')), std::runtime_error);
  EXPECT_THROW(writer.AddMetadata("facts", {}), std::runtime_error);
  EXPECT_THROW(writer.Finish(), std::runtime_error);
  EXPECT_THROW(McapWriter(&out, ""), std::runtime_error);
}

}  // namespace
}  // namespace touchdown::evaluation

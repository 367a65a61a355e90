// SPDX-License-Identifier: BSD-3-Clause
// The format's specification is at mcap.dev/spec. A record is its kind, the length of what follows, and that; numbers are
// little-endian, and lengths stand before strings and lists.
#include "evaluation/mcap/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace touchdown::evaluation {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

template <typename Unsigned>
void Number(std::string* to, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    to->push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU));
  }
}

// With its length before it, of 32 bits, as all lengths but those of a record and of a chunk's records.
void Text(std::string* to, std::string_view text) {
  if (text.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::runtime_error("a part of the file is longer than 4 GiB");
  }
  Number(to, static_cast<std::uint32_t>(text.size()));
  to->append(text);
}

void Map(std::string* to, const McapWriter::Words& words) {
  std::string entries;
  for (const auto& [key, value] : words) {
    Text(&entries, key);
    Text(&entries, value);
  }
  Text(to, entries);
}

std::string Record(Op op, std::string_view content) {
  std::string record;
  record.reserve(content.size() + 9);
  record.push_back(static_cast<char>(op));
  Number(&record, static_cast<std::uint64_t>(content.size()));
  return record.append(content);
}

std::uint32_t Crc(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

McapWriter::McapWriter(std::ostream* out, const std::string& library, std::size_t chunk_size)
    : out_(out), chunk_size_(chunk_size) {
  std::string header;
  Text(&header, "");  // profile: none
  Text(&header, library);
  Put(kMagic);
  Put(Record(Op::kHeader, header));
}

std::uint16_t McapWriter::AddTopic(const std::string& topic, const std::string& schema,
                                   const std::string& descriptors, const Words& metadata) {
  const auto known = std::find(schema_names_.begin(), schema_names_.end(), schema);
  const auto schema_id = static_cast<std::uint16_t>(known - schema_names_.begin() + 1);
  if (known == schema_names_.end()) {
    schema_names_.push_back(schema);
    std::string record;
    Number(&record, schema_id);
    Text(&record, schema);
    Text(&record, "protobuf");
    Text(&record, descriptors);
    schemas_.push_back(Record(Op::kSchema, record));
    chunk_ += schemas_.back();
  }
  const auto channel = static_cast<std::uint16_t>(channels_.size());
  std::string record;
  Number(&record, channel);
  Number(&record, schema_id);
  Text(&record, topic);
  Text(&record, "protobuf");
  Map(&record, metadata);
  channels_.push_back({Record(Op::kChannel, record)});
  chunk_ += channels_.back().record;
  return channel;
}

void McapWriter::Write(std::uint16_t channel, std::uint64_t t_ns, std::string_view message) {
  if (messages_ == 0) first_ns_ = last_ns_ = t_ns;
  if (indices_.empty()) chunk_first_ns_ = chunk_last_ns_ = t_ns;
  first_ns_ = std::min(first_ns_, t_ns);
  last_ns_ = std::max(last_ns_, t_ns);
  chunk_first_ns_ = std::min(chunk_first_ns_, t_ns);
  chunk_last_ns_ = std::max(chunk_last_ns_, t_ns);
  std::string& index = indices_[channel];
  Number(&index, t_ns);
  Number(&index, static_cast<std::uint64_t>(chunk_.size()));
  std::string record;
  Number(&record, channel);
  Number(&record, channels_.at(channel).messages++);  // its sequence number
  Number(&record, t_ns);
  Number(&record, t_ns);
  record.append(message);
  chunk_ += Record(Op::kMessage, record);
  ++messages_;
  if (chunk_.size() >= chunk_size_) CloseChunk();
}

void McapWriter::AddMetadata(const std::string& name, const Words& words) {
  CloseChunk();  // it stands outside of chunks
  std::string content;
  Text(&content, name);
  Map(&content, words);
  const std::string record = Record(Op::kMetadata, content);
  std::string index;
  Number(&index, at_);
  Number(&index, static_cast<std::uint64_t>(record.size()));
  Text(&index, name);
  metadata_indices_.push_back(Record(Op::kMetadataIndex, index));
  Put(record);
}

void McapWriter::Finish() {
  CloseChunk();
  std::string end;
  Number(&end, crc_);
  Put(Record(Op::kDataEnd, end));
  PutSummary();
  Put(kMagic);
  out_->flush();
  CheckStream();
}

void McapWriter::CheckStream() const {
  if (!*out_) throw std::runtime_error("the file cannot be written");
}

void McapWriter::Put(std::string_view bytes) {
  out_->write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  CheckStream();
  at_ += bytes.size();
  crc_ = Crc(crc_, bytes);
}

void McapWriter::CloseChunk() {
  if (chunk_.empty()) return;
  std::string chunk;
  Number(&chunk, chunk_first_ns_);
  Number(&chunk, chunk_last_ns_);
  Number(&chunk, static_cast<std::uint64_t>(chunk_.size()));
  Number(&chunk, Crc(0, chunk_));
  Text(&chunk, "");  // compression: none
  Number(&chunk, static_cast<std::uint64_t>(chunk_.size()));
  const std::uint64_t chunk_at = at_;
  Put(Record(Op::kChunk, chunk.append(chunk_)));
  const std::uint64_t indices_at = at_;
  std::string places;
  for (const auto& [channel, entries] : indices_) {
    Number(&places, channel);
    Number(&places, at_);
    std::string index;
    Number(&index, channel);
    Text(&index, entries);
    Put(Record(Op::kMessageIndex, index));
  }
  std::string index;
  Number(&index, chunk_first_ns_);
  Number(&index, chunk_last_ns_);
  Number(&index, chunk_at);
  Number(&index, indices_at - chunk_at);
  Text(&index, places);
  Number(&index, at_ - indices_at);
  Text(&index, "");
  Number(&index, static_cast<std::uint64_t>(chunk_.size()));
  Number(&index, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indices_.push_back(Record(Op::kChunkIndex, index));
  chunk_.clear();
  indices_.clear();
  chunk_first_ns_ = chunk_last_ns_ = 0;
}

void McapWriter::PutSummary() {
  std::string statistics;
  Number(&statistics, messages_);
  Number(&statistics, static_cast<std::uint16_t>(schemas_.size()));
  Number(&statistics, static_cast<std::uint32_t>(channels_.size()));
  Number(&statistics, std::uint32_t{0});  // attachments
  Number(&statistics, static_cast<std::uint32_t>(metadata_indices_.size()));
  Number(&statistics, static_cast<std::uint32_t>(chunk_indices_.size()));
  Number(&statistics, first_ns_);
  Number(&statistics, last_ns_);
  std::string counts;
  std::vector<std::string> channel_records;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Number(&counts, static_cast<std::uint16_t>(i));
    Number(&counts, static_cast<std::uint64_t>(channels_[i].messages));
    channel_records.push_back(channels_[i].record);
  }
  Text(&statistics, counts);

  const std::uint64_t summary_at = at_;
  crc_ = 0;  // from here on that of the summary
  std::string offsets;
  const auto group = [&](Op op, const std::vector<std::string>& records) {
    if (records.empty()) return;
    const std::uint64_t group_at = at_;
    for (const std::string& record : records) Put(record);
    std::string offset;
    Number(&offset, static_cast<std::uint8_t>(op));
    Number(&offset, group_at);
    Number(&offset, at_ - group_at);
    offsets += Record(Op::kSummaryOffset, offset);
  };
  group(Op::kSchema, schemas_);
  group(Op::kChannel, channel_records);
  group(Op::kStatistics, {Record(Op::kStatistics, statistics)});
  group(Op::kChunkIndex, chunk_indices_);
  group(Op::kMetadataIndex, metadata_indices_);
  std::string footer;
  Number(&footer, summary_at);
  Number(&footer, at_);  // of the offsets
  Put(offsets);
  // The checksum covers the footer up to itself, and the footer's length counts it in.
  const std::string covered = Record(Op::kFooter, footer + std::string(4, '\0'));
  const std::uint32_t crc = Crc(crc_, std::string_view(covered).substr(0, covered.size() - 4));
  Number(&footer, crc);
  Put(Record(Op::kFooter, footer));
}

}  // namespace touchdown::evaluation

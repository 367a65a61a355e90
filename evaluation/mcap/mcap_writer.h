// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation {

/// Writes an MCAP file, version 0 of the format, to a stream. It has uncompressed chunks, message indices, a summary
/// and all of the format's checksums. The file holds only what the writer is given: no time of day, no name of a
/// machine. If the stream fails, the call that notices it throws std::runtime_error.
class McapWriter {
 public:
  using Words = std::map<std::string, std::string>;

  /// @param library who writes. @param chunk_size a chunk is closed when it has so many bytes.
  McapWriter(std::ostream* out, const std::string& library, std::size_t chunk_size = 1U << 20U);

  /// A topic whose messages are protobuf messages of the type `schema`. @param descriptors a serialized FileDescriptorSet with
  /// the type and all that it needs. Topics differ; one schema is stored once. @return its channel
  std::uint16_t AddTopic(const std::string& topic, const std::string& schema,
                         const std::string& descriptors, const Words& metadata = {});

  /// @param t_ns log and publish time [ns].
  void Write(std::uint16_t channel, std::uint64_t t_ns, std::string_view message);

  void AddMetadata(const std::string& name, const Words& words);

  /// Writes what ends the file; nothing can be added any more.
  void Finish();

 private:
  struct Channel {
    std::string record;
    std::uint32_t messages = 0;
  };

  void Put(std::string_view bytes);
  void CheckStream() const;
  void CloseChunk();
  void PutSummary();

  std::ostream* out_;
  std::size_t chunk_size_;
  std::uint64_t at_ = 0;                             ///< bytes written
  std::uint32_t crc_ = 0;                            ///< of these
  std::vector<std::string> schemas_, schema_names_;  ///< records, id from 1
  std::vector<Channel> channels_;                    ///< id from 0
  std::vector<std::string> chunk_indices_, metadata_indices_;
  std::uint64_t messages_ = 0, first_ns_ = 0, last_ns_ = 0;

  std::string chunk_;
  std::map<std::uint16_t, std::string>
      indices_;  ///< of the open chunk: time and offset of each message
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
};

}  // namespace touchdown::evaluation

// SPDX-License-Identifier: BSD-3-Clause
// The one way in which a file that a user names is opened for reading.
#pragma once

#include <cstddef>
#include <string>

namespace touchdown::sim {

/// The most that any reader takes: a mesh of two million triangles as text.
inline constexpr std::size_t kMostInputBytes = 256 << 20;

/// The bytes of the regular file at `path`. A FIFO would block, and a device may never end. `most` is what
/// its reader takes, up to kMostInputBytes. @throws std::invalid_argument "<path>: <why>".
std::string ReadInputFile(const std::string& path, std::size_t most);

/// Its first bytes, `count` at most; none where it is no regular file, or cannot be read.
std::string HeadOfFile(const std::string& path, std::size_t count);

/// @throws std::invalid_argument "<path>: <why>".
[[noreturn]] void RefuseFile(const std::string& path, const std::string& why);

}  // namespace touchdown::sim

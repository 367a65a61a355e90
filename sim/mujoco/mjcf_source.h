// SPDX-License-Identifier: BSD-3-Clause
// What is asked of foreign MJCF before MuJoCo compiles it. MuJoCo opens every file that a text names, also a FIFO, takes
// as much memory as a text declares, and compares each element with all others.
#pragma once

#include <cstddef>
#include <string>

namespace touchdown::sim {

inline constexpr std::size_t kMostMjcfBytes = 4 << 20;  ///< with what a file includes

/// Throws std::invalid_argument "MJCF: ..." unless `mjcf` stands alone, that is, it names no file, and declares no more
/// than MuJoCo compiles in seconds.
void CheckMjcf(const std::string& mjcf);

/// The text of the file at `path` with what it includes in place, and without textures and skins: they are for pictures
/// alone. It may name meshes. Throws as CheckMjcf, and if it or a file that it names is no regular file or too large.
std::string ReadMjcf(const std::string& path);

}  // namespace touchdown::sim

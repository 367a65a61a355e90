// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace touchdown::sim {

/// Printable ASCII characters in MuJoCo's own typeface, as smooth masks. A value type.
class Font {
 public:
  struct Glyph {
    int width = 0;                       ///< [pixel]
    std::vector<std::uint8_t> coverage;  ///< height x width, row 0 at the top, 255: wholly covered
  };

  /// @param size 1 to 6: a line is about 9 pixels high times that. Throws std::invalid_argument for another one,
  /// std::runtime_error if there is no off-screen rendering.
  explicit Font(int size);

  int height() const { return height_; }  ///< of a line [pixel]
  /// The mask of '?' for a character that the font lacks.
  const Glyph& Of(char letter) const;
  int WidthOf(std::string_view text) const;  ///< [pixel]

 private:
  static constexpr int kFirst = 32, kLast = 126;

  int height_ = 0;
  std::array<Glyph, kLast - kFirst + 1> glyphs_;
};

}  // namespace touchdown::sim

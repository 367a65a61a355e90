// SPDX-License-Identifier: BSD-3-Clause
// MuJoCo draws its letters as bitmaps. They are drawn at twice the size and read back. Four pixels become one, so a
// half covered pixel is half as strong. So no font file is needed, and text costs no OpenGL.

#include "sim/rendering/font.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <string>

#include "estimation/base/argument_check.h"
#include "sim/mujoco/mujoco_call.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/rendering/gl_scene.h"

namespace touchdown::sim {
namespace {

constexpr int kSide = 160;  // of the picture of a letter, drawn at twice its size [pixel]
constexpr int kLeft = 8;    // of the letter in it [pixel]
constexpr int kBottom = 8;  // of its line, above the picture's lower edge [pixel]

MujocoModel EmptyModel() {
  const std::string side = std::to_string(kSide);
  return CompileMjcf("<mujoco><visual><global offwidth='" + side + "' offheight='" + side +
                     "'/><quality offsamples='0' shadowsize='0'/></visual><worldbody/></mujoco>");
}

}  // namespace

Font::Font(int size) {
  estimation::CheckWithin("font size", size, 1, 6);
  const MujocoModel model = EmptyModel();
  GlScene gl(*model, 0, mjFONTSCALE_50 * size);
  mjrContext* const render = gl.render();
  height_ = (render->charHeight + 1) / 2;
  const mjrRect all = {0, 0, kSide, kSide};
  std::vector<std::uint8_t> rgb(3 * kSide * kSide);
  for (int letter = kFirst; letter <= kLast; ++letter) {
    const char text[] = {static_cast<char>(letter), '\0'};
    CallMujoco([&] {
      mjr_rectangle(all, 0.0F, 0.0F, 0.0F, 1.0F);
      mjr_text(mjFONT_NORMAL, text, render, static_cast<float>(kLeft) / kSide,
               static_cast<float>(kBottom) / kSide, 1.0F, 1.0F, 1.0F);
      mjr_readPixels(rgb.data(), nullptr, all, render);
    });
    Glyph& glyph = glyphs_[static_cast<std::size_t>(letter - kFirst)];
    glyph.width = (render->charWidth[letter] + 1) / 2;
    for (int row = 0; row < height_; ++row) {
      const int y = kBottom + 2 * (height_ - 1 - row);  // bottom-up
      for (int column = 0; column < glyph.width; ++column) {
        const int x = kLeft + 2 * column;
        const auto at = [&](int dx, int dy) {
          return static_cast<int>(rgb[static_cast<std::size_t>(3 * ((y + dy) * kSide + x + dx))]);
        };
        glyph.coverage.push_back(
            static_cast<std::uint8_t>((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4));
      }
    }
  }
}

const Font::Glyph& Font::Of(char letter) const {
  const bool known = letter >= kFirst && letter <= kLast;
  return glyphs_[static_cast<std::size_t>((known ? letter : '?') - kFirst)];
}

int Font::WidthOf(std::string_view text) const {
  int width = 0;
  for (const char letter : text) width += Of(letter).width;
  return width;
}

}  // namespace touchdown::sim

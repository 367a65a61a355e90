// SPDX-License-Identifier: BSD-3-Clause
// By libpng without any change of values: no gamma, no palette, 16 bits stay 16.
#include <array>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>

#include <png.h>

#include "estimation/base/argument_check.h"
#include "sim/base/input_file.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/world_files.h"

namespace touchdown::sim {
namespace {

constexpr std::size_t kMostPngBytes = 16 << 20;  // 1024 x 1024 pixels, with room for other chunks
constexpr double kThickness = 0.5;  // below the lowest height [m]

struct Png {
  unsigned width = 0, height = 0;
  int bits = 0, color = 0;
  std::vector<unsigned char> bytes;  // rows, big endian
  std::string error;
  std::array<char, 80> why{};  // as libpng says, to be read when its frames are gone
};

void TakeBytes(png_structp read, png_bytep to, std::size_t count) {
  auto& rest = *static_cast<std::string_view*>(png_get_io_ptr(read));
  if (rest.size() < count) png_error(read, "it ends too early");
  std::memcpy(to, rest.data(), count);
  rest.remove_prefix(count);
}

// libpng's errors jump to here: nothing with a destructor lives in this function.
void Decode(std::string_view file, Png* png) {
  png_structp read = png_create_read_struct(
      PNG_LIBPNG_VER_STRING, png,
      [](png_structp in, png_const_charp why) {
        std::strncpy(static_cast<Png*>(png_get_error_ptr(in))->why.data(), why, 79);
        png_longjmp(in, 1);
      },
      [](png_structp, png_const_charp) {});
  png_infop info = read == nullptr ? nullptr : png_create_info_struct(read);
  if (info == nullptr) {
    png->error = "there is no memory for it";
    png_destroy_read_struct(&read, nullptr, nullptr);
    return;
  }
  if (setjmp(png_jmpbuf(read)) == 0) {
    png_set_read_fn(read, &file, TakeBytes);
    // Compressed texts and profiles: they are not even inflated.
    png_set_keep_unknown_chunks(read, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_user_limits(read, HeightGrid::kMostSide, HeightGrid::kMostSide);
    png_read_info(read, info);
    png->width = png_get_image_width(read, info);
    png->height = png_get_image_height(read, info);
    png->bits = png_get_bit_depth(read, info);
    png->color = png_get_color_type(read, info);
    if (png->color == PNG_COLOR_TYPE_GRAY && png->bits >= 8) {
      png_set_interlace_handling(read);
      png_read_update_info(read, info);
      const std::size_t stride = png_get_rowbytes(read, info);
      png->bytes.resize(stride * png->height);
      for (int pass = png_get_interlace_type(read, info) == PNG_INTERLACE_NONE ? 1 : 7; pass > 0;
           --pass) {
        for (unsigned row = 0; row < png->height; ++row) {
          png_read_row(read, png->bytes.data() + row * stride, nullptr);
        }
      }
    }
  }
  png_destroy_read_struct(&read, &info, nullptr);
  if (png->why[0] != 0) png->error = png->why.data();
}

}  // namespace

Obstacle ObstacleOfHeightFile(const std::string& path, const Eigen::Vector2d& size, double height,
                              const Placement& placement) {
  estimation::CheckAbove("height of a height field's white [m]", height, 0.0, 1000.0);
  Png png;
  Decode(ReadInputFile(path, kMostPngBytes), &png);
  if (!png.error.empty())
    RefuseFile(path, "it is no sound PNG of at most 1024 x 1024: " + png.error);
  if (png.color != PNG_COLOR_TYPE_GRAY || png.bits < 8) {
    RefuseFile(path, "it is no grey PNG of 8 or 16 bits");
  }
  HeightGrid grid{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  const std::size_t pixels = static_cast<std::size_t>(png.width) * png.height;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double value = png.bits == 8 ? png.bytes[i] / 255.0
                                       : (256.0 * png.bytes[2 * i] + png.bytes[2 * i + 1]) / 65535.0;
    grid.heights.push_back(height * value);
  }
  try {
    return Mesh{std::make_shared<const TriangleMesh>(
        HeightFieldMesh(grid, size, kThickness, placement))};
  } catch (const std::invalid_argument& error) {
    RefuseFile(path, error.what());
  }
}

}  // namespace touchdown::sim

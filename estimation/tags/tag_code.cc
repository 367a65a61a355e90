// SPDX-License-Identifier: BSD-3-Clause
// What is printed on a marker, by libapriltag's own apriltag_to_image.

#include "estimation/tags/tag_code.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace touchdown::estimation {

TagCode TagCodeOf(int id) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  if (id < 0 || id >= static_cast<int>(family->ncodes)) {
    throw std::invalid_argument("tag id is " + std::to_string(id) + "; allowed is [0, " +
                                std::to_string(family->ncodes - 1) + "]");
  }
  const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> image(
      apriltag_to_image(family.get(), id), image_u8_destroy);
  TagCode code{};
  for (int row = 0; row < kTagCells; ++row) {
    for (int column = 0; column < kTagCells; ++column) {
      code[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
          image->buf[row * image->stride + column];
    }
  }
  return code;
}

}  // namespace touchdown::estimation

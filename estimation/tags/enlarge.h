// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/base/gray_image.h"

namespace touchdown::estimation {

/// The image at twice its size: a point at (u, v) comes to lie at (2 u, 2 v). `twice` is resized if
/// it has another size, else nothing is allocated.
void EnlargeTwice(const GrayImageView& image, GrayImage* twice);

}  // namespace touchdown::estimation

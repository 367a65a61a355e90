// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/base/gray_image.h"

namespace touchdown::sim {

/// A texture like worn asphalt, always the same, whose edges match each other. @param texels along
/// each side, a power of two from 8 on.
estimation::GrayImage GroundTexture(int texels);

}  // namespace touchdown::sim

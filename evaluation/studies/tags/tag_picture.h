// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "touchdown/estimation/tags/pad_finder.h"

namespace touchdown::evaluation {

/// Writes an image three times its size with the detections drawn into it. A tag's outline has its first side in
/// yellow, the others in green. Where the pose was solved, the sheet's edge is drawn in red with a line from its centre
/// along the pad's x axis. A binary PPM file.
/// @throws std::runtime_error naming a file that cannot be written.
void WriteTagPicture(const std::string& path, const estimation::GrayImage& image,
                     const estimation::PadView& view, const estimation::CameraIntrinsics& camera);

}  // namespace touchdown::evaluation

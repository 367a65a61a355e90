// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/studies/tags/tag_study.h"
#include "sim/sensors/tag_sensor.h"

namespace touchdown::evaluation {

/// The constants with which the fast tag camera agrees with the rendered one in these views.
/// @throws std::invalid_argument if no view found the pad.
sim::TagModel FitTagModel(const TagStudyOptions& options, const std::vector<TagStudyRow>& rows);

/// Both cameras over the views of one range of heights.
struct TagAgreement {
  double from = 0.0, to = 0.0;                  ///< [m]
  int views = 0;                                ///< with a whole tag in the image
  double rendered_rate = 0.0, fast_rate = 0.0;  ///< of poses found
  Quantiles rendered_mm, fast_mm;               ///< position errors
};

/// The fast camera looks twenty times from each view.
TagAgreement CompareTagCameras(const TagStudyOptions& options, const std::vector<TagStudyRow>& rows,
                               double from, double to, const sim::TagModel& model);

/// The same for each range of heights.
std::vector<TagAgreement> CompareTagCameras(const TagStudyOptions& options,
                                            const std::vector<TagStudyRow>& rows,
                                            const sim::TagModel& model);

/// The constants as they stand in sim/pad/tag_model.h, and how well both cameras agree.
std::string TagFitText(const sim::TagModel& model, const std::vector<TagAgreement>& agreement);
nlohmann::ordered_json TagFitJson(const sim::TagModel& model,
                                  const std::vector<TagAgreement>& agreement);

}  // namespace touchdown::evaluation

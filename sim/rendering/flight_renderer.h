// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/rendering/scene_mjcf.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// A line in the air, through its points.
struct FlightLine {
  std::vector<Eigen::Vector3d> points_W;  ///< [m]
  double width = 0.03;                    ///< [m], > 0
  std::array<float, 4> rgba = {1.0F, 1.0F, 1.0F, 1.0F};
};

/// A ball in the air.
struct FlightMark {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.1;                            ///< [m], > 0
  std::array<float, 4> rgba = {1.0F, 1.0F, 1.0F, 1.0F};
};

/// The visible scene at one time.
struct FlightMoment {
  CameraPose camera;
  estimation::VehicleState vehicle;
  estimation::PadState pad;
  std::vector<FlightLine> lines;
  std::vector<FlightMark> marks;
};

/// Pictures of a flight for people: the scene of SceneRenderer with the vehicle, lines, sky and shadows. The same input
/// gives the same bits. Belongs to the thread that made it.
class FlightRenderer {
 public:
  /// Throws as SceneRenderer does, and for a vehicle as LooksOf.
  FlightRenderer(const VisualScene& scene, const std::string& vehicle_mjcf, const ViewConfig& view);
  FlightRenderer(FlightRenderer&&) noexcept;
  FlightRenderer& operator=(FlightRenderer&&) noexcept;
  ~FlightRenderer();

  /// @param rgb height x width x 3, row-major, row 0 at the top; resized. At most kMostPieces are drawn: the marks,
  /// then the pieces of the lines in order, each line from its first point on. The others are left out.
  void Render(const FlightMoment& moment, std::vector<std::uint8_t>* rgb);

  static constexpr int kMostPieces = 4000;

  const estimation::CameraIntrinsics& intrinsics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::sim

// SPDX-License-Identifier: BSD-3-Clause
// The parts that cameras see are those of SceneMjcf; light, sky and haze are for people. Measured in MuJoCo 2.2.2 with
// OSMesa at 1280 x 720: shadows double the time of a frame, and multisampling would double it once more. In a wood
// every stack of MuJoCo's cylinders and capsules costs time (12 of them: a third more than 4).

#include "sim/rendering/flight_scene_mjcf.h"

#include <sstream>

#include "estimation/base/argument_check.h"
#include "sim/rendering/vehicle_looks.h"

namespace touchdown::sim {
namespace {

// A shadow map holds the surface of each thing that is farthest from the sun. For a sheet as thin as paper this would
// be its upper face, which would then lie in its own shadow in places.
constexpr double kSheetDepth = 0.015;  // [m]

}  // namespace

std::string FlightSceneMjcf(const VisualScene& scene, const std::string& vehicle_mjcf,
                            const ViewConfig& view) {
  const VehicleLooks looks = LooksOf(vehicle_mjcf);
  std::ostringstream xml;
  xml << "<mujoco model='touchdown flight scene'>\n"
      << "<compiler angle='degree'/>\n"
      << "<default><geom contype='0' conaffinity='0'/></default>\n"
      << "<statistic extent='1' center='0 0 0'/>\n"
      << "<visual>\n"
      << "<global offwidth='" << view.width << "' offheight='" << view.height << "'/>\n"
      << "<quality offsamples='0' shadowsize='4096' numslices='32' numstacks='4'/>\n"
      << "<map znear='" << estimation::NumberText(view.near) << "' zfar='"
      << estimation::NumberText(view.far) << "' shadowclip='16' fogstart='18' fogend='75'/>\n"
      << "<rgba fog='0.80 0.86 0.92 1'/>\n"
      << "<headlight ambient='0.46 0.47 0.50' diffuse='0.10 0.10 0.10' specular='0 0 0'/>\n"
      << "</visual>\n"
      << "<asset>\n"
      << "<texture type='skybox' builtin='gradient' rgb1='0.80 0.86 0.92' rgb2='0.30 0.50 0.76' "
      << "width='256' height='1536'/>\n"
      << SceneAssets(scene) << looks.assets << "</asset>\n"
      << "<worldbody>\n"
      << "<light directional='true' castshadow='true' pos='0 0 30' dir='0.42 0.30 -1' "
      << "ambient='0 0 0' diffuse='0.58 0.56 0.51' specular='0.25 0.25 0.25'/>\n"
      << SceneBodies(scene, view, kSheetDepth) << "<body name='vehicle' mocap='true'>\n"
      << looks.geoms << "</body>\n"
      << "</worldbody>\n"
      << "</mujoco>\n";
  return xml.str();
}

}  // namespace touchdown::sim

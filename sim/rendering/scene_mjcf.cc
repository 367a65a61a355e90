// SPDX-License-Identifier: BSD-3-Clause
// The scene for the renderer. Choices, measured in MuJoCo 2.2.2 with OSMesa:
// - no multisampling and no shadows: each triples the time of a frame;
// - statistic extent 1: the clipping planes are then in metres;
// - 96 facets to a cylinder: nowhere more than 0.05 % of its radius too thin;
// - the marker sheet is a thin box: a plane on a mocap body does not compile.
// The sheet's upper face is the deck's: the board below it is drawn that much thinner.

#include "sim/rendering/scene_mjcf.h"

#include <sstream>

#include "estimation/base/argument_check.h"
#include "estimation/tags/pad_sheet.h"
#include "sim/mujoco/mjcf_text.h"

namespace touchdown::sim {
namespace {

constexpr double kSheetThickness = 0.0005;  // [m]
constexpr double kPlateThickness = 0.004;   // of what covers a part of it [m]
constexpr double kGroundPeriod = 4.0;       // the ground's texture repeats after [m]

std::string NameOf(std::size_t obstacle) { return "obstacle " + std::to_string(obstacle); }

const char* MaterialOf(const Obstacle& obstacle) {
  const bool round =
      std::holds_alternative<Cylinder>(obstacle) || std::holds_alternative<Sphere>(obstacle);
  return round ? "cylinder" : "box";
}

void WriteGeom(const Box& box, const char* name, std::ostream& xml) {
  xml << "<geom name='" << name << "' material='" << name << "' " << GeomText(box, name, "a scene")
      << "/>\n";
}

void WritePad(const VisualScene& scene, double sheet_depth, std::ostream& xml) {
  estimation::PadState pad;
  pad.p_WP.z() = scene.deck_height;
  const Eigen::Vector3d origin = pad.p_WP;
  Box deck = DeckBox(scene.pad, pad);
  Box body = PadBodyBox(scene.pad, pad);
  deck.center.z() -= 0.5 * kSheetThickness;
  deck.half_extents.z() -= 0.5 * kSheetThickness;
  deck.center -= origin;
  body.center -= origin;
  const Box sheet{
      {0.0, 0.0, -0.5 * sheet_depth},
      {0.5 * estimation::kPadSheetSide, 0.5 * estimation::kPadSheetSide, 0.5 * sheet_depth},
      0.0};
  xml << "<body name='pad' mocap='true'>\n";
  WriteGeom(deck, "deck", xml);
  WriteGeom(body, "pad_body", xml);
  WriteGeom(sheet, "pad", xml);
  if (scene.occlusion > 0.0) {
    const double half = 0.5 * estimation::kPadSheetSide;
    const double edge = PlateEdge(scene.occlusion);
    WriteGeom({{0.5 * (half + edge), 0.0, 0.5 * kPlateThickness},
               {0.5 * (half - edge), half, 0.5 * kPlateThickness},
               0.0},
              "plate", xml);
  }
  xml << "</body>\n";
}

}  // namespace

std::string SceneAssets(const VisualScene& scene) {
  std::ostringstream xml;
  const std::string repeat = estimation::NumberText(1.0 / kGroundPeriod);
  xml << "<texture name='ground' type='2d' builtin='flat' rgb1='1 1 1' width='" << kGroundTexels
      << "' height='" << kGroundTexels << "'/>\n"
      << "<texture name='pad' type='2d' builtin='flat' rgb1='1 1 1' width='"
      << estimation::kPadSheetTexels << "' height='" << estimation::kPadSheetTexels << "'/>\n"
      << "<material name='ground' texture='ground' texuniform='true' texrepeat='" << repeat << ' '
      << repeat << "' specular='0'/>\n"
      << "<material name='pad' texture='pad' texuniform='false' texrepeat='1 1' specular='0'/>\n"
      << "<material name='box' rgba='0.72 0.50 0.34 1' specular='0'/>\n"
      << "<material name='cylinder' rgba='0.36 0.55 0.38 1' specular='0'/>\n"
      << "<material name='deck' rgba='0.62 0.62 0.66 1' specular='0'/>\n"
      << "<material name='plate' rgba='0.45 0.45 0.45 1' specular='0'/>\n"
      << "<material name='pad_body' rgba='0.25 0.30 0.42 1' specular='0'/>\n";
  const std::vector<Obstacle>& obstacles = scene.obstacles.obstacles();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (const auto* mesh = std::get_if<Mesh>(&obstacles[i])) {
      xml << MeshAssetText(mesh->surface->corners(), mesh->surface->triangles(), NameOf(i));
    }
  }
  return xml.str();
}

std::string SceneBodies(const VisualScene& scene, const ViewConfig& view, double sheet) {
  std::ostringstream xml;
  xml << "<geom name='ground' type='plane' size='0 0 1' material='ground'/>\n";
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const Obstacle& obstacle = scene.obstacles.obstacles()[i];
    xml << "<geom material='" << MaterialOf(obstacle) << "' "
        << GeomText(obstacle, NameOf(i), "a rendered scene") << "/>\n";
  }
  WritePad(scene, sheet, xml);
  xml << "<body name='camera' mocap='true'>\n"
      << "<camera name='camera' fovy='" << estimation::NumberText(view.fov_y_deg) << "'/>\n"
      << "</body>\n";
  return xml.str();
}

std::string SceneMjcf(const VisualScene& scene, const ViewConfig& view) {
  std::ostringstream xml;
  xml << "<mujoco model='touchdown scene'>\n"
      << "<compiler angle='degree'/>\n"
      << "<default><geom contype='0' conaffinity='0'/></default>\n"
      << "<statistic extent='1' center='0 0 0'/>\n"
      << "<visual>\n"
      << "<global offwidth='" << view.width << "' offheight='" << view.height << "'/>\n"
      << "<quality offsamples='0' shadowsize='0' numslices='96'/>\n"
      << "<map znear='" << estimation::NumberText(view.near) << "' zfar='"
      << estimation::NumberText(view.far) << "'/>\n"
      << "<headlight ambient='0.5 0.5 0.5' diffuse='0 0 0' specular='0 0 0'/>\n"
      << "</visual>\n"
      << "<asset>\n"
      << SceneAssets(scene) << "</asset>\n"
      << "<worldbody>\n"
      << "<light directional='true' castshadow='false' pos='0 0 10' dir='0.2 0.3 -1' "
      << "ambient='0 0 0' diffuse='0.45 0.45 0.45' specular='0 0 0'/>\n"
      << SceneBodies(scene, view, kSheetThickness) << "</worldbody>\n"
      << "</mujoco>\n";
  return xml.str();
}

}  // namespace touchdown::sim

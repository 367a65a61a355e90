// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scenario/obstacle_keys.h"

#include <utility>

#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation {
namespace {

template <typename Element>
SchemaKey<Element> Optional(SchemaKey<Element> key) {
  key.optional = true;
  return key;
}

template <typename Element>
SchemaKey<Element> BaseKey() {
  return Optional(schema::Number<Element>(
      "base", schema::In(0, 100, "m"),
      "height of the lower face above the ground: a roof, a bridge", TOUCHDOWN_AT(base)));
}

template <typename Element>
SchemaKey<Element> TurnKey(const char* about) {
  return Optional(schema::Vector<3, Element>("turn_deg", schema::In(-360, 360, "deg"),
                                             std::string("roll, pitch and yaw ").append(about),
                                             TOUCHDOWN_AT(turn_deg)));
}

template <typename Element>
SchemaKey<Element> YawKey() {
  return Optional(schema::Number<Element>("yaw_deg", schema::In(-360, 360, "deg"),
                                          "turn about the vertical through the file's origin",
                                          TOUCHDOWN_AT(yaw_deg)));
}

template <typename Element>
SchemaKey<Element> FileKey(const char* what) {
  return schema::Text<Element>("file", "a path", what, TOUCHDOWN_AT(file));
}

template <typename Element>
SchemaKey<Element> PlaceKey(const char* what) {
  return Optional(
      schema::Vector<3, Element>("at", schema::In(-1e4, 1e4, "m"), what, TOUCHDOWN_AT(at)));
}

// x and y of two points or more.
SchemaKey<WallObstacle> PointsKey() {
  const auto range = schema::In(-600, 600, "m");
  return {"points",
          "m",
          range.ToString(),
          "x and y in W of each point of the middle line: two points or more",
          [range](WallObstacle& wall, const YAML::Node& node, const Where& where) {
            const int size = node.IsSequence() ? static_cast<int>(node.size()) : 0;
            if (size < 4 || size % 2 != 0) {
              RefuseValue(where, "points", "a flat list x, y, x, y, ... of two points or more",
                          node);
            }
            const Eigen::VectorXd values = ReadVector(node, where, "points", size, range);
            wall.points.assign(values.begin(), values.end());
          },
          [](const WallObstacle& wall) {
            return WriteVector(Eigen::Map<const Eigen::VectorXd>(
                wall.points.data(), static_cast<Eigen::Index>(wall.points.size())));
          }};
}

}  // namespace

const ElementKeys<BoxObstacle>& BoxKeys() {
  static const ElementKeys<BoxObstacle> keys = {
      schema::Vector<2, BoxObstacle>("centre", schema::In(-600, 600, "m"),
                                     "centre of the base in W", TOUCHDOWN_AT(centre)),
      schema::Vector<3, BoxObstacle>("size", schema::Above(0, 100, "m"), "edges along x, y and z",
                                     TOUCHDOWN_AT(size)),
      BaseKey<BoxObstacle>(), TurnKey<BoxObstacle>("about its middle")};
  return keys;
}

const ElementKeys<CylinderObstacle>& CylinderKeys() {
  static const ElementKeys<CylinderObstacle> keys = {
      schema::Vector<2, CylinderObstacle>("centre", schema::In(-600, 600, "m"),
                                          "centre of the base in W", TOUCHDOWN_AT(centre)),
      schema::Number<CylinderObstacle>("radius", schema::Above(0, 50, "m"), "radius",
                                       TOUCHDOWN_AT(radius)),
      schema::Number<CylinderObstacle>("height", schema::Above(0, 100, "m"), "height",
                                       TOUCHDOWN_AT(height)),
      BaseKey<CylinderObstacle>()};
  return keys;
}

const ElementKeys<SphereObstacle>& SphereKeys() {
  static const ElementKeys<SphereObstacle> keys = {
      schema::Vector<3, SphereObstacle>("centre", schema::In(-600, 600, "m"), "middle in W",
                                        TOUCHDOWN_AT(centre)),
      schema::Number<SphereObstacle>("radius", schema::Above(0, 50, "m"), "radius",
                                     TOUCHDOWN_AT(radius))};
  return keys;
}

const ElementKeys<WallObstacle>& WallKeys() {
  static const ElementKeys<WallObstacle> keys = {
      PointsKey(),
      Optional(schema::Number<WallObstacle>("thickness", schema::Above(0, 10, "m"), "thickness",
                                            TOUCHDOWN_AT(thickness))),
      Optional(schema::Number<WallObstacle>("height", schema::Above(0, 100, "m"), "height",
                                            TOUCHDOWN_AT(height))),
      BaseKey<WallObstacle>()};
  return keys;
}

const ElementKeys<MeshObstacle>& MeshKeys() {
  static const ElementKeys<MeshObstacle> keys = {
      FileKey<MeshObstacle>(
          "closed surfaces of triangles: OBJ, STL, PLY, OFF, Collada (.dae), binary glTF (.glb)"),
      Optional(schema::Number<MeshObstacle>("scale", schema::Above(0, 1e6, ""),
                                            "metres to the file's unit of length",
                                            TOUCHDOWN_AT(scale))),
      PlaceKey<MeshObstacle>("place of the file's origin in W"),
      TurnKey<MeshObstacle>("about the file's origin")};
  return keys;
}

const ElementKeys<HeightFieldObstacle>& HeightFieldKeys() {
  static const ElementKeys<HeightFieldObstacle> keys = {
      FileKey<HeightFieldObstacle>(
          "grey PNG of 8 or 16 bits, at most 1024 x 1024, the first row at the greatest y"),
      schema::Vector<2, HeightFieldObstacle>("size", schema::Above(0, 1000, "m"),
                                             "extent along x and y", TOUCHDOWN_AT(size)),
      schema::Number<HeightFieldObstacle>("height", schema::Above(0, 1000, "m"),
                                          "height of white above black", TOUCHDOWN_AT(height)),
      PlaceKey<HeightFieldObstacle>("place in W of its middle where the picture is black"),
      YawKey<HeightFieldObstacle>()};
  return keys;
}

const ElementKeys<OctomapObstacle>& OctomapKeys() {
  static const ElementKeys<OctomapObstacle> keys = {
      FileKey<OctomapObstacle>("OctoMap file (.bt or .ot) of any cell size: its occupied cells"),
      PlaceKey<OctomapObstacle>("place of the file's origin in W"), YawKey<OctomapObstacle>(),
      Optional(schema::Vector<3, OctomapObstacle>(
          "crop_min", schema::In(-1e4, 1e4, "m"),
          "cells whose middle is below this, in the file's frame, are left out",
          TOUCHDOWN_AT(crop_min))),
      Optional(schema::Vector<3, OctomapObstacle>("crop_max", schema::In(-1e4, 1e4, "m"),
                                                  "... or above this", TOUCHDOWN_AT(crop_max)))};
  return keys;
}

const ElementKeys<DepthMount>& DepthMountKeys() {
  static const ElementKeys<DepthMount> keys = {
      Optional(schema::Vector<3, DepthMount>("position", schema::In(-2, 2, "m"),
                                             "of the camera in B: forward, left, up",
                                             TOUCHDOWN_AT(position))),
      Optional(schema::Number<DepthMount>("yaw_deg", schema::In(-180, 180, "deg"),
                                          "of its axis, to the left of the nose",
                                          TOUCHDOWN_AT(yaw_deg))),
      Optional(schema::Number<DepthMount>("pitch_deg", schema::In(-90, 90, "deg"),
                                          "of its axis, downward: 90 looks down",
                                          TOUCHDOWN_AT(pitch_deg))),
      Optional(schema::Number<DepthMount>("fov_deg", schema::In(10, 170, "deg"),
                                          "horizontal field of view", TOUCHDOWN_AT(fov_deg))),
      Optional(schema::Number<DepthMount>("rate", schema::Above(0, 100, "Hz"), "images a second",
                                          TOUCHDOWN_AT(rate)))};
  return keys;
}

}  // namespace touchdown::evaluation

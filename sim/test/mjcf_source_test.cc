// SPDX-License-Identifier: BSD-3-Clause
#include "sim/mujoco/mjcf_source.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/mujoco/mujoco_model.h"
#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

namespace fs = std::filesystem;
using test::MessageOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class MjcfSource : public ::testing::Test {
 protected:
  MjcfSource() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "meshes");
  }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::string Refusal(const std::string& text) const {
    const std::string path = Write("refused.xml", text);
    return MessageOf<std::invalid_argument>([&] { ReadMjcf(path); });
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / "mjcf_source";
};

constexpr char kTetrahedron[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(MjcfSource, WhatNeedsNoChangeStaysAsItIs) {
  const std::string text = "<mujoco>\n<worldbody><geom  size='1'/></worldbody></mujoco>\n";
  EXPECT_EQ(ReadMjcf(Write("plain.xml", text)), text);
}

TEST_F(MjcfSource, IncludesComeInPlaceAndPicturesAreLeftOut) {
  Write("part.xml",
        "<part><asset><texture name='t' file='t.png'/><material name='m' texture='t'/>"
        "<mesh name='s' file='solid.obj'/></asset></part>");
  Write("meshes/solid.obj", kTetrahedron);
  const std::string path = Write(
      "whole.xml",
      "<mujoco><compiler meshdir='meshes'/><include file='part.xml'/><worldbody><body><freejoint/>"
      "<geom type='mesh' mesh='s' material='m'/></body></worldbody></mujoco>");
  EXPECT_THAT(ReadMjcf(path),
              AllOf(HasSubstr("solid.obj"), Not(HasSubstr("texture")), Not(HasSubstr("include"))));
  EXPECT_NE(CompileMjcfFile(path), nullptr);
}

TEST_F(MjcfSource, AFlatMeshIsOneSentence) {
  const std::string path = Write(
      "flat.xml",
      "<mujoco><asset><mesh name='flat' vertex='0 0 0  1 0 0  0 1 0  1 1 0'/></asset>"
      "<worldbody><body><freejoint/><geom type='mesh' mesh='flat'/></body></worldbody></mujoco>");
  ::testing::internal::CaptureStderr();
  EXPECT_THAT(MessageOf<std::invalid_argument>([&] { CompileMjcfFile(path); }), HasSubstr("flat"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(MjcfSource, FilesWithoutAnEndAreNotOpened) {
  EXPECT_THAT(Refusal("<mujoco><include file='/dev/zero'/></mujoco>"), HasSubstr("/dev/zero"));
  EXPECT_THAT(Refusal("<mujoco><asset><mesh file='/dev/zero'/></asset></mujoco>"),
              HasSubstr("/dev/zero"));
  EXPECT_THAT(Refusal("<mujoco><include file='refused.xml'/></mujoco>"), HasSubstr("again"));
  // MuJoCo looks for it by its last name alone, too.
  fs::create_directory(folder_ / "meshes/solid.obj");
  EXPECT_THAT(Refusal("<mujoco><compiler meshdir='meshes' strippath='true'/>"
                      "<asset><mesh file='elsewhere/solid.obj'/></asset></mujoco>"),
              HasSubstr("directory"));
}

TEST_F(MjcfSource, WhatIsDeclaredIsBounded) {
  const auto refusal = [](const std::string& inside) {
    return MessageOf<std::invalid_argument>([&] { CheckMjcf("<mujoco>" + inside + "</mujoco>"); });
  };
  EXPECT_EQ(refusal("<size nstack='1000000' njmax='500'/><numeric size='3'/>"), "");
  EXPECT_THAT(refusal("<size\nnjmax='1e9'/>"), HasSubstr("<size> in line 1 has njmax 1e9"));
  EXPECT_THAT(refusal("<size nconmax='nan'/>"), HasSubstr("nconmax nan"));
  EXPECT_THAT(refusal("<texture width='4000'/>"), HasSubstr("at most 2048"));
  EXPECT_THAT(refusal("<numeric size='2000000000'/>"), HasSubstr("<numeric>"));
  EXPECT_THAT(refusal("<composite/>"), HasSubstr("<composite>"));
  EXPECT_THAT(refusal("<texture fileup='up.png'/>"), HasSubstr("names a file"));
  std::string geoms;
  for (int i = 0; i < 4000; ++i) geoms += "<geom/>";
  EXPECT_THAT(refusal(geoms), HasSubstr("one too many"));
  EXPECT_THAT(refusal("<"), HasSubstr("no XML"));
}

}  // namespace
}  // namespace touchdown::sim

#pragma once
/// The six kinds of scene and what they are called, also in the names of tests: .ci/run chooses by them.

#include <raycloud/synth/scenes.h>

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace ray::test {

constexpr std::array kSceneKinds{SceneKind::room,   SceneKind::building, SceneKind::tree,
                                 SceneKind::forest, SceneKind::terrain,  SceneKind::field};

inline std::string word_of(SceneKind kind) {
  constexpr std::array kWords{"room", "building", "tree", "forest", "terrain", "field"};
  return kWords.at(static_cast<std::size_t>(kind));
}

/// The last argument of INSTANTIATE_TEST_SUITE_P.
inline std::string name_by_scene(const testing::TestParamInfo<SceneKind>& test) {
  return word_of(test.param);
}

}  // namespace ray::test

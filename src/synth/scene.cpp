#include <raycloud/synth/scene.h>

#include <array>

namespace ray {

std::string label_name(SceneLabel label) {
  static constexpr std::array kNames{"nothing",      "ground",       "wall",    "floor", "ceiling", "door",
                                     "window_frame", "furniture",    "stairs",  "trunk", "branch",  "leaf",
                                     "understorey",  "fallen_trunk", "boulder", "grass", "crop",    "fence",
                                     "hedge",        "person",       "vehicle"};
  return kNames.at(static_cast<std::size_t>(label));
}

bool SceneObject::is_transient() const {
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  return !motion.empty() || present.first > -kAlways || present.second < kAlways;
}

}  // namespace ray

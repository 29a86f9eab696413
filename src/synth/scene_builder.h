#pragma once
/// Puts a scene together.

#include <raycloud/exec/random.h>
#include <raycloud/synth/scene.h>

#include <string>
#include <utility>

namespace ray {

class SceneBuilder {
 public:
  SceneBuilder(std::string kind, std::uint64_t seed) {
    scene_.kind = std::move(kind);
    scene_.seed = seed;
  }

  /// The id of an object is its index. Returns it, valid until the next one is added.
  SceneObject& add(SceneLabel label, std::string name, Mesh mesh) {
    SceneObject object;
    object.id = static_cast<std::int32_t>(scene_.objects.size());
    object.label = label;
    object.name = std::move(name);
    object.mesh = std::move(mesh);
    scene_.objects.push_back(std::move(object));
    return scene_.objects.back();
  }
  void fact(std::string name, double value, std::string unit) {
    scene_.facts.push_back({std::move(name), value, std::move(unit)});
  }
  [[nodiscard]] RandomStream random(const std::string& purpose) const {
    return {scene_.seed, scene_.kind + " " + purpose};
  }
  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] Scene take() { return std::move(scene_); }

 private:
  Scene scene_;
};

/// A number of [low, high), keyed by what it is for.
[[nodiscard]] inline double between(double low, double high, const RandomStream& random, std::uint64_t index,
                                    std::uint64_t draw = 0) {
  return low + (high - low) * random.uniform(index, draw);
}

}  // namespace ray

#include "scene_kinds.h"

#include <raycloud/synth/scenes.h>

namespace ray {

std::optional<SceneKind> scene_kind(std::string_view word) {
  if (word == "room") return SceneKind::room;
  if (word == "building") return SceneKind::building;
  if (word == "tree") return SceneKind::tree;
  if (word == "forest") return SceneKind::forest;
  if (word == "terrain") return SceneKind::terrain;
  if (word == "field") return SceneKind::field;
  return std::nullopt;
}

Scene make_scene(SceneKind kind, std::uint64_t seed) {
  switch (kind) {
    case SceneKind::room:
      return make_room(seed);
    case SceneKind::building:
      return make_building(seed);
    case SceneKind::tree:
      return make_tree(seed);
    case SceneKind::forest:
      return make_forest(seed);
    case SceneKind::terrain:
      return make_terrain(seed);
    case SceneKind::field:
      break;
  }
  return make_field(seed);
}

}  // namespace ray

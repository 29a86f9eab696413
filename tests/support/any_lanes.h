#pragma once
/// Loops of all widths, for properties to be true of each.

#include <raycloud/core/lanes.h>

#include <rapidcheck.h>

namespace ray {

/// As long as it lives, loops take that many lanes, or as many as the processor can.
class AnyLanes {
 public:
  AnyLanes() : fewer_(*rc::gen::element(LaneSet::kPlain, LaneSet::kAvx2, LaneSet::kAvx512)) {}

 private:
  FewerLanes fewer_;
};

}  // namespace ray

// Any bytes as a tree file: trees whose parents come before their children come out or ray::Error, and
// nothing else.
#include "fuzz/input_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/tree_file.h>

#include <cmath>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ray::fuzz::InputFile file(data, size);
  try {
    const ray::Forest forest = ray::read_trees(file.path());
    for (const ray::Tree& tree : forest.trees) {
      if (tree.segments.empty() || tree.attributes.size() != forest.tree_attributes.size()) std::abort();
      for (std::size_t i = 0; i < tree.segments.size(); ++i) {
        const ray::TreeSegment& segment = tree.segments[i];
        if (i == 0 ? segment.parent != ray::TreeSegment::kNoParent : segment.parent >= i) std::abort();
        if (!segment.position.allFinite() || !(segment.radius >= 0.0)) std::abort();
        if (segment.attributes.size() != forest.segment_attributes.size()) std::abort();
      }
    }
  } catch (const ray::Error&) {  // the only way a reader may fail
  }
  return 0;
}

// Any bytes as the text of a trajectory, under each of the readings that a name asks for: a path with finite
// nodes in the order of time comes out or ray::Error, and nothing else.
#include <raycloud/core/error.h>
#include <raycloud/io/trajectory_file.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

void read(std::string_view text, const std::string& name, const std::string& format) {
  try {
    const ray::Trajectory path = ray::parse_trajectory(text, name, {.format = format}).trajectory;
    if (path.times.empty() || path.positions.size() != path.times.size()) std::abort();
    for (std::size_t i = 0; i < path.times.size(); ++i) {
      if (!std::isfinite(path.times[i]) || !path.positions[i].allFinite()) std::abort();
      if (i > 0 && !(path.times[i - 1] < path.times[i])) std::abort();
    }
  } catch (const ray::Error&) {  // the only way a reader may fail
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read(text, "path.txt", "");
  read(text, "path.tum", "");
  read(text, "path.csv", "x,y,z,-,t");
  return 0;
}

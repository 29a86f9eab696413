// Any bytes as a .ply file, read as a ray cloud and as points: rays come out or ray::Error, and nothing else.
#include "fuzz/drain.h"
#include "fuzz/input_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ply_cloud.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ray::fuzz::InputFile file(data, size);
  for (const auto open : {ray::open_ply, ray::open_ply_points}) {
    try {
      ray::fuzz::drain(*open(file.path(), {.chunk_rays = 7}));
    } catch (const ray::Error&) {  // the only way a reader may fail
    }
  }
  return 0;
}

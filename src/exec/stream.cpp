#include <raycloud/exec/stream.h>

namespace ray {

RayCloud read_all(const Context& context, RaySource& source) {
  RayCloud all;
  all.set_schema(source.info().extras);
  stream(
      context, source, nullptr, [](RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing&) { all.append(rays); });
  return all;
}

}  // namespace ray

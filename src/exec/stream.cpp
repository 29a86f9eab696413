#include <raycloud/exec/stream.h>

namespace ray {

std::vector<std::uint32_t> rows_of(std::span<const std::uint8_t> mask) {
  std::vector<std::uint32_t> rows(mask.size() + 1);
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    // Without a branch: whether a ray is kept is often close to a coin toss.
    rows[count] = static_cast<std::uint32_t>(i);
    count += mask[i] != 0 ? 1 : 0;
  }
  rows.resize(count);
  return rows;
}

RayCloud read_all(const Context& context, RaySource& source) {
  RayCloud all;
  all.set_schema(source.info().extras);
  stream(
      context, source, nullptr, [](RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing&) { all.append(rays); });
  return all;
}

}  // namespace ray

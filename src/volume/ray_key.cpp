#include "ray_key.h"

#include "mix_bits.h"

#include <bit>
#include <cstring>

namespace ray {
namespace {

void add_word(RayKey& key, std::uint64_t word) {
  key.high = mix_bits(key.high + word + 0x9e3779b97f4a7c15ULL);
  key.low = mix_bits((key.low ^ word) * 0xd6e8feb86659fd93ULL + 0xa0761d6478bd642fULL);
}

void add_number(RayKey& key, double number) {
  add_word(key, std::bit_cast<std::uint64_t>(number + 0.0));  // -0 is 0
}

}  // namespace

std::vector<RayKey> ray_keys(const RayCloud& rays, const RayKeyRule& rule) {
  std::vector<const Column*> columns;
  for (const std::string& name : rule.columns)
    columns.push_back(rays.extra(name));
  std::vector<RayKey> keys(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayKey& key = keys[i];
    for (int axis = 0; axis < 3; ++axis) {
      const double vector = rays.starts[i][axis] - rays.ends[i][axis];
      add_number(key, rays.ends[i][axis]);
      add_number(key, rule.single_vectors ? static_cast<double>(static_cast<float>(vector)) : vector);
    }
    add_number(key, rays.times[i]);
    const Colour& colour = rays.colours[i];
    add_word(key, std::uint64_t{colour.red} | std::uint64_t{colour.green} << 8 |
                      std::uint64_t{colour.blue} << 16 | std::uint64_t{colour.intensity} << 24 |
                      std::uint64_t{rays.bounded[i]} << 32);
    for (const Column* column : columns) {
      std::uint64_t word = 0;
      std::memcpy(&word, column->data() + i * column->stride(), column->stride());
      add_word(key, word);
    }
  }
  return keys;
}

}  // namespace ray

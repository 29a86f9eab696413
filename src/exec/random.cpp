#include <raycloud/exec/random.h>

namespace ray {

namespace {

std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) : key_(mix(seed)) {
  for (const char c : name)
    key_ = mix(key_ ^ static_cast<unsigned char>(c));
}

std::uint64_t RandomStream::bits(std::uint64_t index, std::uint64_t draw) const {
  return mix(mix(key_ ^ index) ^ draw);
}

double RandomStream::uniform(std::uint64_t index, std::uint64_t draw) const {
  return static_cast<double>(bits(index, draw) >> 11) * 0x1.0p-53;
}

std::uint64_t RandomStream::below(std::uint64_t count, std::uint64_t index, std::uint64_t draw) const {
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::uint64_t>((static_cast<Wide>(bits(index, draw)) * count) >> 64);
}

}  // namespace ray

#include "source_sample.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <span>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kMostChunks = 4;

struct Picked {
  std::vector<RawChunk> chunks;
  std::uint64_t fetched = 0;
};

// Every stride-th chunk, the stride doubling whenever there are too many, and the last.
Picked pick_chunks(const Context& context, RaySource& source) {
  Picked picked;
  RawChunk raw;
  RawChunk last;
  std::uint64_t stride = 1;
  bool last_is_picked = true;
  for (; source.fetch(raw); ++picked.fetched) {
    check_cancelled(context);
    last_is_picked = picked.fetched % stride == 0;
    if (!last_is_picked) {
      std::swap(raw, last);
      continue;
    }
    if (picked.chunks.size() == kMostChunks) {
      for (std::size_t i = 0; 2 * i < kMostChunks; ++i)
        picked.chunks[i] = std::move(picked.chunks[2 * i]);
      picked.chunks.resize(kMostChunks / 2);
      stride *= 2;
    }
    picked.chunks.push_back(std::exchange(raw, {}));
  }
  if (!last_is_picked) {
    if (picked.chunks.size() == kMostChunks) picked.chunks.pop_back();
    picked.chunks.push_back(std::move(last));
  }
  return picked;
}

SourceSample look_at(const RaySource& source, const RawChunk& raw, const std::string& intensity) {
  SourceSample part;
  RayCloud rays;
  part.invalid = source.decode(raw, rays);
  part.rays = rays.size();
  for (const double time : rays.times)
    part.times.add(time);
  part.intensity = intensity_range(rays, intensity);
  for (const Column& column : rays.extras)
    part.recorded.push_back(is_recorded(column) ? 1 : 0);
  if (!rays.empty()) part.first_start = rays.starts.front();
  return part;
}

}  // namespace

bool is_recorded(const Column& column) {
  const std::span bytes(column.data(), column.size() * column.stride());
  return std::any_of(bytes.begin(), bytes.end(), [](std::byte b) { return b != std::byte{0}; });
}

SourceSample sample_source(const Context& context, RaySource& source, const std::string& intensity) {
  source.rewind();
  const Picked picked = pick_chunks(context, source);
  source.rewind();
  std::vector<SourceSample> parts(picked.chunks.size());
  parallel_for(context, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      parts[i] = look_at(source, picked.chunks[i], intensity);
  });
  SourceSample sample;
  sample.recorded.resize(source.info().extras.size());
  sample.complete = picked.fetched == picked.chunks.size();
  for (const SourceSample& part : parts) {
    sample.rays += part.rays;
    sample.invalid += part.invalid;
    sample.intensity.add(part.intensity);
    for (std::size_t i = 0; i < part.recorded.size(); ++i)
      sample.recorded[i] |= part.recorded[i];
    if (!part.times.empty()) {
      sample.times.add(part.times.first);
      sample.times.add(part.times.last);
    }
    if (!sample.first_start) sample.first_start = part.first_start;
  }
  return sample;
}

}  // namespace ray

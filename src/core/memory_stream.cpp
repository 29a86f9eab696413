#include <raycloud/core/memory_stream.h>

#include <algorithm>
#include <cstring>

namespace ray {

namespace {

template <class T>
void put(std::byte*& out, const std::vector<T>& values) {
  const std::size_t bytes = values.size() * sizeof(T);
  if (bytes != 0) std::memcpy(out, values.data(), bytes);
  out += bytes;
}

template <class T>
void take(const std::byte*& in, std::vector<T>& values) {
  const std::size_t bytes = values.size() * sizeof(T);
  if (bytes != 0) std::memcpy(static_cast<void*>(values.data()), in, bytes);
  in += bytes;
}

template <class T>
void copy_rows(const std::vector<T>& from, std::size_t first, std::size_t rows, std::vector<T>& to) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
  to.assign(begin, begin + static_cast<std::ptrdiff_t>(rows));
}

}  // namespace

MemorySource::MemorySource(const RayCloud& cloud, std::size_t chunk_rays)
    : MemorySource(cloud, CloudInfo{}, chunk_rays) {
  info_.precision = Precision::double_;
}

MemorySource::MemorySource(const RayCloud& cloud, CloudInfo info, std::size_t chunk_rays)
    : cloud_(cloud), info_(std::move(info)), chunk_rays_(chunk_rays) {
  info_.ray_count = cloud.size();
  info_.extras = schema_of(cloud);
}

bool MemorySource::fetch(RawChunk& raw) {
  raw.first_row = next_;
  raw.rows = std::min(chunk_rays_, cloud_.size() - next_);
  next_ += raw.rows;
  return raw.rows != 0;
}

std::size_t MemorySource::decode(const RawChunk& raw, RayCloud& rays) const {
  const auto first = static_cast<std::size_t>(raw.first_row);
  copy_rows(cloud_.starts, first, raw.rows, rays.starts);
  copy_rows(cloud_.ends, first, raw.rows, rays.ends);
  copy_rows(cloud_.times, first, raw.rows, rays.times);
  copy_rows(cloud_.colours, first, raw.rows, rays.colours);
  copy_rows(cloud_.bounded, first, raw.rows, rays.bounded);
  rays.set_schema(info_.extras);
  for (std::size_t i = 0; i < rays.extras.size(); ++i) {
    Column& to = rays.extras[i];
    const std::size_t bytes = raw.rows * to.stride();
    if (bytes != 0) std::memcpy(to.data(), cloud_.extras[i].data() + first * to.stride(), bytes);
  }
  return drop_not_finite(rays);
}

MemorySink::MemorySink(std::vector<ColumnInfo> extras) {
  cloud_.set_schema(extras);
}

void MemorySink::encode(const RayCloud& rays, RawChunk& raw) const {
  std::size_t row_bytes = 2 * sizeof(Eigen::Vector3d) + sizeof(double) + sizeof(Colour) + 1;
  for (const Column& column : rays.extras)
    row_bytes += column.stride();
  raw.rows = rays.size();
  raw.bytes.resize(raw.rows * row_bytes);
  std::byte* out = raw.bytes.data();
  put(out, rays.starts);
  put(out, rays.ends);
  put(out, rays.times);
  put(out, rays.colours);
  put(out, rays.bounded);
  for (const Column& column : rays.extras) {
    const std::size_t bytes = raw.rows * column.stride();
    if (bytes != 0) std::memcpy(out, column.data(), bytes);
    out += bytes;
  }
}

void MemorySink::write(const RawChunk& raw) {
  RayCloud rays;
  rays.set_schema(schema_of(cloud_));
  rays.resize(raw.rows);
  const std::byte* in = raw.bytes.data();
  take(in, rays.starts);
  take(in, rays.ends);
  take(in, rays.times);
  take(in, rays.colours);
  take(in, rays.bounded);
  for (Column& column : rays.extras) {
    const std::size_t bytes = raw.rows * column.stride();
    if (bytes != 0) std::memcpy(column.data(), in, bytes);
    in += bytes;
  }
  cloud_.append(rays);
}

}  // namespace ray

#include <raycloud/core/column.h>

#include <cstring>

namespace ray {

double Column::as_double(std::size_t row) const {
  return visit_scalar(type(), [&]<class T>() { return static_cast<double>(values<T>()[row]); });
}

void Column::select(std::span<const std::uint8_t> mask) {
  assert(mask.size() == size());
  std::size_t kept = 0;
  for (std::size_t row = 0; row < mask.size(); ++row) {
    if (mask[row] == 0) continue;
    if (kept != row) std::memcpy(data() + kept * stride_, data() + row * stride_, stride_);
    ++kept;
  }
  resize(kept);
}

void Column::append(const Column& other) {
  assert(other.type() == type());
  bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
}

}  // namespace ray

#pragma once
/// Large arrays, ready to be filled.

#include <raycloud/exec/context.h>

#include <cassert>
#include <cstddef>
#include <vector>

namespace ray {

/// Writes to every page of new memory, with all threads. The system gives memory page by page, when it is
/// first touched, and clears it: up to 4 s a GB, measured on a virtual machine.
void touch_pages(const Context& context, void* memory, std::size_t bytes);

/// As vector.reserve(count), but what is reserved is there: one thread fills it as fast as memory that was
/// used before. Precondition: the vector has no elements.
template <class T>
void reserve_touched(const Context& context, std::vector<T>& vector, std::size_t count) {
  assert(vector.empty());
  if (vector.capacity() >= count) return;
  vector.reserve(count);
  touch_pages(context, static_cast<void*>(vector.data()), count * sizeof(T));
}

/// As std::vector<T>(count), for many.
template <class T>
[[nodiscard]] std::vector<T> touched_vector(const Context& context, std::size_t count) {
  std::vector<T> vector;
  reserve_touched(context, vector, count);
  vector.resize(count);
  return vector;
}

}  // namespace ray

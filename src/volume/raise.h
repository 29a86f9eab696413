#pragma once
/// A maximum that many threads find together.

#include <atomic>

namespace ray {

/// Thread-safe; the result does not depend on the order of the calls.
inline void raise(float& value, float to) {
  const std::atomic_ref<float> atomic(value);
  float known = atomic.load(std::memory_order_relaxed);
  while (known < to && !atomic.compare_exchange_weak(known, to, std::memory_order_relaxed)) {
  }
}

}  // namespace ray

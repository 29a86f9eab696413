#pragma once
/// For calls into a library that forgets memory of its own.

#if defined(__SANITIZE_ADDRESS__)
#define RAYCLOUD_LEAKS_ARE_LOOKED_FOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RAYCLOUD_LEAKS_ARE_LOOKED_FOR
#endif
#endif

#ifdef RAYCLOUD_LEAKS_ARE_LOOKED_FOR
#include <sanitizer/lsan_interface.h>
#endif

namespace ray::test {

/// While one lives, the leak check overlooks what this thread allocates.
class ForeignLeaks {
 public:
#ifdef RAYCLOUD_LEAKS_ARE_LOOKED_FOR
  ForeignLeaks() {
    __lsan_disable();
  }
  ~ForeignLeaks() {
    __lsan_enable();
  }
#else
  ForeignLeaks() {}
  ~ForeignLeaks() {}
#endif
  ForeignLeaks(const ForeignLeaks&) = delete;
  ForeignLeaks& operator=(const ForeignLeaks&) = delete;
};

}  // namespace ray::test

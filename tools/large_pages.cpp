// Memory that is asked for in megabytes comes in large pages: neighbourhoods are looked up all over a cloud,
// and with pages of 4 kB much of a look goes into finding the page. Debian's kernels give large ones to all,
// Ubuntu's to those who ask. What is given back is kept for the next step, as new memory has to be cleared
// first. Measured with 16 M rays: `raydenoise 4 cm` takes 0.8 of the time, `raysmooth` and `raytransients`
// 0.95. Results are the same. Programs that use the library may do as the commands do.

#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#if !defined(__has_feature)
#define RAY_HAS_FEATURE(feature) 0
#else
#define RAY_HAS_FEATURE(feature) __has_feature(feature)
#endif
#if !RAY_HAS_FEATURE(address_sanitizer) && !RAY_HAS_FEATURE(memory_sanitizer)

#include <malloc.h>
#include <sys/mman.h>

#include <new>

namespace {

constexpr std::size_t kPage = std::size_t{2} << 20;
constexpr std::size_t kLarge = 2 * kPage;

bool keep_memory() {
  constexpr int kMost = 1 << 30;
  return mallopt(M_MMAP_THRESHOLD, kMost) != 0 && mallopt(M_TRIM_THRESHOLD, kMost) != 0;
}
[[maybe_unused]] const bool kIsKept = keep_memory();

void* allocate(std::size_t size) {
  if (size < kLarge) return std::malloc(size == 0 ? 1 : size);
  const std::size_t pages = size / kPage + 1;
  void* const memory = std::aligned_alloc(kPage, pages * kPage);
  if (memory != nullptr) madvise(memory, pages * kPage, MADV_HUGEPAGE);
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  while (true) {
    if (void* const memory = allocate(size)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

#endif
#endif

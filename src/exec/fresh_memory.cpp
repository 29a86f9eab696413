#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>

namespace ray {

void touch_pages(const Context& context, void* memory, std::size_t bytes) {
  constexpr std::size_t kPage = 4096, kPart = std::size_t{8} << 20;
  parallel_for(context, bytes, kPart, [&](std::size_t begin, std::size_t end) {
    auto* const at = static_cast<volatile unsigned char*>(memory);
    for (std::size_t i = begin; i < end; i += kPage)
      at[i] = 0;
  });
}

}  // namespace ray

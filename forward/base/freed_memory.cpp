#include "forward/base/freed_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace mezzotint {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int own_mapping_from = 32 << 20, kept = 1 << 30;
  if (std::getenv("MALLOC_MMAP_THRESHOLD_") == nullptr) mallopt(M_MMAP_THRESHOLD, own_mapping_from);
  if (std::getenv("MALLOC_TRIM_THRESHOLD_") == nullptr) mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

}  // namespace mezzotint

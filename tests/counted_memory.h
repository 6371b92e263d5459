#pragma once

#include <malloc.h>
#include <atomic>
#include <cstdlib>
#include <new>

// What a piece of work takes from the heap by `new` at its height: for tests of memory. Include it in one source file
// of a program alone, since it replaces the program's operators.

namespace mezzotint::test {

inline std::atomic<std::size_t> bytes_in_use{0}, most_in_use{0};

inline void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = bytes_in_use += malloc_usable_size(memory);
  std::size_t most = most_in_use;
  while (now > most && !most_in_use.compare_exchange_weak(most, now)) {
  }
  return memory;
}

inline void release(void* memory) {
  if (memory == nullptr) return;
  bytes_in_use -= malloc_usable_size(memory);
  std::free(memory);
}

/// Bytes that `work` held at once, beyond what was held before.
template <class Work>
std::size_t peak_bytes(const Work& work) {
  const std::size_t before = bytes_in_use;
  most_in_use = before;
  work();
  return most_in_use - before;
}

}  // namespace mezzotint::test

void* operator new(std::size_t size) { return mezzotint::test::counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return mezzotint::test::counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* memory) noexcept { mezzotint::test::release(memory); }
void operator delete(void* memory, std::size_t) noexcept { mezzotint::test::release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { mezzotint::test::release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { mezzotint::test::release(memory); }

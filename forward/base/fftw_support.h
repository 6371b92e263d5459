#pragma once

#include <fftw3.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>

/// Inside of forward/base: what our transforms share of FFTW.

namespace mezzotint {

inline constexpr std::size_t longest_side = std::size_t{1} << 16;

// FFTW's planner keeps global tables and is not thread-safe; executing a plan is.
inline std::mutex& fftw_planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct FreeFftw {
  void operator()(void* memory) const { fftw_free(memory); }
};

template <class T>
std::unique_ptr<T[], FreeFftw> allocate_aligned(std::size_t count) {
  auto* memory = static_cast<T*>(fftw_malloc(count * sizeof(T)));
  if (memory == nullptr) throw std::bad_alloc();
  std::fill_n(memory, count, T{});
  return std::unique_ptr<T[], FreeFftw>(memory);
}

}  // namespace mezzotint

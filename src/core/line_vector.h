#pragma once
// Arrays that begin at a cache line. Where they do not, every vector of eight doubles lies in two lines, and each is touched twice.

#include <cstddef>
#include <new>
#include <vector>

namespace tsubu {

inline constexpr std::size_t cacheLine = 64;  // bytes; of every x86-64 processor and most others

template <class T>
struct LineAllocator {
  using value_type = T;

  LineAllocator() = default;
  template <class Other>
  explicit(false) LineAllocator(const LineAllocator<Other>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{cacheLine})); }
  void deallocate(T* start, std::size_t) { ::operator delete (start, std::align_val_t{cacheLine}); }
  bool operator==(const LineAllocator&) const { return true; }
};

template <class T>
using LineVector = std::vector<T, LineAllocator<T>>;

/// `count` rounded up to whole lines.
template <class T>
constexpr std::size_t wholeLines(std::size_t count) {
  constexpr std::size_t each = cacheLine / sizeof(T);
  return (count + each - 1) / each * each;
}

}  // namespace tsubu

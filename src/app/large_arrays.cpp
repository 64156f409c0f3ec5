#include "app/large_arrays.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace {

constexpr std::size_t page = std::size_t{2} << 20;  // what x86-64 and most ARM systems have beside 4 KiB

// Contacts read the rows of grains here and there, and with small pages a processor looks up where each of them lies: 6 % of a step of half
// a million grains. Whole large pages only: of the last piece no more memory is taken than the array has.
void askForLargePages([[maybe_unused]] void* start, [[maybe_unused]] std::size_t size) {
#ifdef MADV_HUGEPAGE
  madvise(start, size & ~(page - 1), MADV_HUGEPAGE);
#endif
}

}  // namespace

// Rows and columns of grains, contacts and bonds are the over-aligned arrays (sim/grain_rows.h, core/line_vector.h).
void* operator new(std::size_t size, std::align_val_t alignment) {
  const bool large = size >= 2 * page;
  const std::size_t boundary = large ? page : static_cast<std::size_t>(alignment);
  void* const start = std::aligned_alloc(boundary, (size + boundary - 1) & ~(boundary - 1));
  if (!start) throw std::bad_alloc();
  if (large) askForLargePages(start, size);
  return start;
}
void operator delete(void* start, std::align_val_t) noexcept { std::free(start); }
void operator delete(void* start, std::size_t, std::align_val_t) noexcept { std::free(start); }

namespace tsubu::app {

void returnLargeArrays() {
#ifdef __GLIBC__
  // So that old and new neighbour lists do not add up in large beds. Smaller arrays are used again: pages that come anew cost time.
  mallopt(M_MMAP_THRESHOLD, 4 * 1024 * 1024);
  mallopt(M_TRIM_THRESHOLD, 4 * 1024 * 1024);  // the usual 128 KiB gives the arrays of a small bed back at every search
#endif
}

}  // namespace tsubu::app

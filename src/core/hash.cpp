#include "core/hash.h"

#include <fmt/format.h>

namespace tsubu {

std::uint64_t mix64(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

void Hash::add(std::uint64_t word) { state_ = mix64(state_ ^ mix64(word)); }

std::string Hash::text() const { return fmt::format("{:016x}", state_); }

}  // namespace tsubu

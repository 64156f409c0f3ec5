#pragma once
// A fingerprint of numbers, for comparing states bit by bit.

#include <cstdint>
#include <cstring>
#include <string>

namespace tsubu {

/// Order-dependent 64-bit hash (splitmix64 finaliser over a running state). Not cryptographic. -0.0 and 0.0 differ, as bits do.
class Hash {
 public:
  void add(std::uint64_t word);
  void add(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  std::uint64_t value() const { return state_; }
  /// Sixteen hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t state_ = 0x7473756275ULL;  // "tsubu"
};

/// The splitmix64 finaliser: a good mixing of 64 bits.
std::uint64_t mix64(std::uint64_t word);

}  // namespace tsubu

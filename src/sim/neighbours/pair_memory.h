#pragma once
// What listed contacts remember, in columns along a list: component c of pair k. In single numbers where contacts are computed in these.

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/line_vector.h"

namespace tsubu::sim {

/// Gives a vector whose entries are all to be written a new size: with a little room to grow, where the standard library doubles it.
template <class Vector>
void fit(Vector& items, std::size_t count) {
  if (count > items.capacity() || items.capacity() > 2 * count + 1024) {
    items = Vector();
    items.reserve(count + count / 16);
  }
  items.resize(count);
}

class PairMemory {
 public:
  PairMemory() = default;
  explicit PairMemory(bool single) : single_(single) {}

  /// Room for these pairs, each column in whole cache lines; what is there for them is to be written, and what lies beyond never read for
  /// one.
  void fit(std::size_t pairs, std::size_t components) {
    stride_ = single_ ? wholeLines<float>(pairs) : wholeLines<double>(pairs);
    if (single_)
      sim::fit(narrow_, stride_ * components);
    else
      sim::fit(wide_, stride_ * components);
  }
  std::size_t stride() const { return stride_; }

  double at(std::size_t component, std::size_t pair) const {
    const std::size_t k = component * stride_ + pair;
    return single_ ? static_cast<double>(narrow_[k]) : wide_[k];
  }
  void set(std::size_t component, std::size_t pair, double value) {
    const std::size_t k = component * stride_ + pair;
    if (single_)
      narrow_[k] = static_cast<float>(value);
    else
      wide_[k] = value;
  }

  /// Component c of pair k at [c * stride() + k]; `Real` as the columns are.
  template <class Real>
  Real* columns() {
    return columnsOf<Real>().data();
  }
  template <class Real>
  const Real* columns() const {
    return const_cast<PairMemory*>(this)->columnsOf<Real>().data();
  }
  /// The columns of doubles, one after the other, with what lies between them.
  LineVector<double>& wide() { return wide_; }
  const LineVector<double>& wide() const { return wide_; }

 private:
  template <class Real>
  LineVector<Real>& columnsOf() {
    if constexpr (std::is_same_v<Real, float>)
      return narrow_;
    else
      return wide_;
  }

  bool single_ = false;
  std::size_t stride_ = 0;
  LineVector<double> wide_;
  LineVector<float> narrow_;
};

}  // namespace tsubu::sim

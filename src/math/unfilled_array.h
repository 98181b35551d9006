#pragma once

#include <tbb/blocked_range.h>
#include <tbb/cache_aligned_allocator.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace vdbeam {

/// Leaves elements that are given no value as their memory is. To write a large array twice, once
/// by a single thread, is what limits how much faster many threads are.
template <class T>
class UnfilledAllocator : public tbb::cache_aligned_allocator<T> {
public:
  template <class U>
  struct rebind {
    using other = UnfilledAllocator<U>;
  };
  UnfilledAllocator() = default;
  template <class U>
  explicit UnfilledAllocator(const UnfilledAllocator<U>&) {}

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
  }
};

/// A vector whose new elements have no value until they are written.
template <class T>
using UnfilledArray = std::vector<T, UnfilledAllocator<T>>;

/// Elements that one thread copies at a time.
inline constexpr std::size_t copied_at_once = 16384;

/// Copies `from` to `to`, which has room for them, by all threads.
template <class T>
void copy_in_parallel(const UnfilledArray<T>& from, T* to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), copied_at_once),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      std::copy(from.data() + range.begin(), from.data() + range.end(),
                                to + range.begin());
                    });
}

} // namespace vdbeam

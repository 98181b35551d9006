#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace vdbeam {

/// Leaves elements that are given no value as their memory is. To write a large array twice, once
/// by a single thread, is what limits how much faster many threads are.
template <class T>
class UnfilledAllocator {
public:
  using value_type = T;
  UnfilledAllocator() = default;
  template <class U>
  explicit UnfilledAllocator(const UnfilledAllocator<U>&) {}

  /// By the C library, which gives large arrays back to the system; TBB's allocator would keep
  /// them.
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{cache_line}));
  }
  void deallocate(T* place, std::size_t) {
    ::operator delete (place, std::align_val_t{cache_line});
  }
  bool operator==(const UnfilledAllocator&) const { return true; }

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
  }

private:
  static constexpr std::size_t cache_line = 64;
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

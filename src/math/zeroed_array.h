#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace vdbeam {

/// Takes memory that the system has cleared, which it does where a page is first written: an array
/// costs nothing until it is used, and then each thread pays for its own pages. Only for types of
/// which zero bytes are a value.
template <class T>
class ZeroedAllocator {
public:
  static_assert(std::is_arithmetic_v<T>);
  using value_type = T;
  ZeroedAllocator() = default;
  template <class U>
  explicit ZeroedAllocator(const ZeroedAllocator<U>&) {}

  T* allocate(std::size_t count) {
    void* place = std::calloc(count, sizeof(T)); // which checks the product
    if (!place)
      throw std::bad_alloc();
    return static_cast<T*>(place);
  }
  void deallocate(T* place, std::size_t) { std::free(place); }
  bool operator==(const ZeroedAllocator&) const { return true; }

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
  }
};

/// A vector of numbers that is made with its final size: its elements are 0. (Shrunk and grown
/// again, it would show old values.)
template <class T>
using ZeroedArray = std::vector<T, ZeroedAllocator<T>>;

} // namespace vdbeam

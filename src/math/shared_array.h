#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace vdbeam {

/// An immutable array that copies share, so that objects with large arrays can be copied at no
/// cost.
template <class T>
class SharedArray {
public:
  SharedArray() = default;
  explicit SharedArray(std::vector<T> values)
      : values_(std::make_shared<const std::vector<T>>(std::move(values))), data_(values_->data()),
        size_(values_->size()) {}

  const T& operator[](std::size_t i) const { return data_[i]; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return size_ * sizeof(T); }

private:
  std::shared_ptr<const std::vector<T>> values_;
  const T* data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace vdbeam

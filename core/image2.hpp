#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace ensonify {

/// Dense row-major array of two dimensions, a value type.
/// Sonar images: rows = range bins (row 0 nearest), columns = beams (column 0 port-most).
template <typename T>
class Image2 {
 public:
  using value_type = T;

  Image2() = default;
  Image2(int rows, int columns, T fill = T{})
      : rows_(rows), columns_(columns), data_(static_cast<std::size_t>(rows) * columns, fill) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }

  T& operator()(int row, int column) { return data_[index(row, column)]; }
  const T& operator()(int row, int column) const { return data_[index(row, column)]; }

  std::span<T> row(int r) { return {data_.data() + index(r, 0), static_cast<std::size_t>(columns_)}; }
  std::span<const T> row(int r) const { return {data_.data() + index(r, 0), static_cast<std::size_t>(columns_)}; }
  std::span<T> pixels() { return data_; }
  std::span<const T> pixels() const { return data_; }

  bool operator==(const Image2&) const = default;

 private:
  std::size_t index(int row, int column) const {
    assert(row >= 0 && row < rows_ && column >= 0 && column <= columns_);
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  int rows_ = 0;
  int columns_ = 0;
  std::vector<T> data_;
};

}  // namespace ensonify

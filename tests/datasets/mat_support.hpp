#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <zlib.h>

namespace waymark::test {

/// The header of a level 5 file, 128 bytes.
inline std::string mat_header() {
  std::string header = "MATLAB 5.0 MAT-file, written by a test";
  header.resize(124, ' ');
  return header + std::string("\x00\x01IM", 4);
}

/// One element: data type, size, bytes, padding.
inline std::string mat_element(std::uint32_t type, std::string_view data) {
  std::string element(8, '\0');
  const auto size = static_cast<std::uint32_t>(data.size());
  std::memcpy(element.data(), &type, 4);
  std::memcpy(element.data() + 4, &size, 4);
  element += data;
  element.resize((element.size() + 7) / 8 * 8);
  return element;
}

inline std::string bytes_of(const void* data, std::size_t size) {
  return {static_cast<const char*>(data), size};
}

/// A variable of doubles as an uncompressed element.
inline std::string mat_variable(std::string_view name, const Eigen::MatrixXd& values) {
  const std::uint32_t flags[2] = {6, 0};
  const std::int32_t dimensions[2] = {static_cast<std::int32_t>(values.rows()),
                                      static_cast<std::int32_t>(values.cols())};
  const auto size = static_cast<std::size_t>(values.size()) * sizeof(double);
  return mat_element(14, mat_element(6, bytes_of(flags, 8)) + mat_element(5, bytes_of(dimensions, 8)) +
                             mat_element(1, name) + mat_element(9, bytes_of(values.data(), size)));
}

/// A row of cells, each a matrix of doubles.
inline std::string mat_cells(std::string_view name, const std::vector<Eigen::MatrixXd>& cells) {
  const std::uint32_t flags[2] = {1, 0};
  const std::int32_t dimensions[2] = {1, static_cast<std::int32_t>(cells.size())};
  std::string inner =
      mat_element(6, bytes_of(flags, 8)) + mat_element(5, bytes_of(dimensions, 8)) + mat_element(1, name);
  for (const Eigen::MatrixXd& cell : cells) inner += mat_variable("", cell);
  return mat_element(14, inner);
}

/// Any element as MATLAB compresses it.
inline std::string mat_compressed(std::string_view element) {
  auto size = compressBound(static_cast<uLong>(element.size()));
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(element.data()), static_cast<uLong>(element.size())),
            Z_OK);
  packed.resize(size);
  std::string tag(8, '\0');
  const std::uint32_t words[2] = {15, static_cast<std::uint32_t>(size)};
  std::memcpy(tag.data(), words, 8);
  return tag + packed;
}

}  // namespace waymark::test

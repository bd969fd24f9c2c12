#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "waymark/core/pose2.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// Writes a trajectory in the TUM format, rows of `stamp_s tx ty tz qx qy qz qw` with z = 0, while it is
/// being computed. Rows wait in a buffer and are on disk after flush(), close() or destruction. The same
/// poses give the same bytes. About 0.2 us per row.
class TumWriter {
 public:
  [[nodiscard]] static Result<TumWriter> open(const std::filesystem::path& path);
  TumWriter(TumWriter&&) = default;
  TumWriter& operator=(TumWriter&&) = delete;
  ~TumWriter();

  void write(Stamp stamp, const Pose2& pose);
  void flush();

  /// Nothing more will be written; tells whether all of it reached the file.
  [[nodiscard]] Result<void> close();

 private:
  TumWriter(std::filesystem::path path, std::ofstream file);

  std::filesystem::path path_;
  std::ofstream file_;
  std::string buffer_;
};

}  // namespace waymark

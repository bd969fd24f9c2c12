#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/result.hpp"

namespace waymark {

/// The variables of a MATLAB file (level 5), all of them plain real matrices.
class MatFile {
 public:
  /// Reads the whole file. A damaged one is an error, never a crash or a part of the data.
  [[nodiscard]] static Result<MatFile> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view variable) const { return variables_.contains(variable); }
  [[nodiscard]] bool has_all(const std::vector<std::string_view>& variables) const;
  /// "DR, GT, TD"
  [[nodiscard]] std::string names() const;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// A variable with so many columns; `meaning` ("time, x, y") helps where it has others. All its values are
  /// finite.
  [[nodiscard]] Result<Eigen::MatrixXd> matrix(std::string_view variable, Eigen::Index columns,
                                               std::string_view meaning) const;

 private:
  std::filesystem::path path_;
  std::map<std::string, Eigen::MatrixXd, std::less<>> variables_;
};

}  // namespace waymark

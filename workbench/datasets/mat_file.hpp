#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/result.hpp"

struct matvar_t;  // of libmatio

namespace waymark {

/// The variables of a MATLAB file (level 5): plain real matrices, and cell arrays of them.
class MatFile {
 public:
  /// Reads the whole file. A damaged one is an error, never a crash or a part of the data.
  [[nodiscard]] static Result<MatFile> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view variable) const {
    return variables_.contains(variable) || cells_.contains(variable);
  }
  [[nodiscard]] bool has_all(const std::vector<std::string_view>& variables) const;
  /// "DR, GT, TD"; cell arrays stand last.
  [[nodiscard]] std::string names() const;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// A variable with so many columns; `meaning` ("time, x, y") helps where it has others. All its values are
  /// finite.
  [[nodiscard]] Result<Eigen::MatrixXd> matrix(std::string_view variable, Eigen::Index columns,
                                               std::string_view meaning) const;

  /// The same of a variable that lies on its side: so many rows, which become the columns.
  [[nodiscard]] Result<Eigen::MatrixXd> transposed(std::string_view variable, Eigen::Index rows,
                                                   std::string_view meaning) const;

  /// The values of a variable that is one column or one row.
  [[nodiscard]] Result<Eigen::VectorXd> vector(std::string_view variable, std::string_view meaning) const;

  /// The matrices of a cell array, each with so many rows or empty.
  [[nodiscard]] Result<std::vector<Eigen::MatrixXd>> cells(std::string_view variable, Eigen::Index rows,
                                                           std::string_view meaning) const;

 private:
  /// False: it is neither a plain matrix nor cells of them.
  [[nodiscard]] bool add(const matvar_t& variable);
  [[nodiscard]] Error missing(std::string_view variable, std::string_view meaning) const;
  /// Null: there is no such matrix.
  [[nodiscard]] const Eigen::MatrixXd* find(std::string_view variable) const;

  std::filesystem::path path_;
  std::map<std::string, Eigen::MatrixXd, std::less<>> variables_;
  std::map<std::string, std::vector<Eigen::MatrixXd>, std::less<>> cells_;
};

}  // namespace waymark
